// The limits of control groups, read from files as the system writes them.
#include "driver/world/limits.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>

namespace bounce {
namespace {

namespace fs = std::filesystem;

constexpr double endless = std::numeric_limits<double>::infinity();

class ControlGroupsTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "bounce-groups-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    root_ = name;
  }
  void TearDown() override { fs::remove_all(root_); }
  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text << "\n";
  }
  [[nodiscard]] int cores(const std::string& names) const { return cores_by_quota({names, root_}); }
  [[nodiscard]] double memory(const std::string& names) const {
    return memory_by_limits({names, root_});
  }
  fs::path root_;
};

TEST_F(ControlGroupsTest, CoresAreFreeWithoutAQuota) {
  EXPECT_EQ(cores(""), no_quota);
  EXPECT_EQ(cores("0::/a\n"), no_quota);
  write("cpu.max", "max 100000");
  write("a/cpu.max", "max 100000");
  EXPECT_EQ(cores("0::/a\n"), no_quota);
  write("cpu/a/cpu.cfs_quota_us", "-1");
  write("cpu/a/cpu.cfs_period_us", "100000");
  EXPECT_EQ(cores("4:cpu,cpuacct:/a\n"), no_quota);
}

TEST_F(ControlGroupsTest, CoresAreRoundedDownButNeverNone) {
  write("a/cpu.max", "250000 100000");
  EXPECT_EQ(cores("0::/a\n"), 2);
  write("a/cpu.max", "50000 100000");
  EXPECT_EQ(cores("0::/a\n"), 1);
  write("a/cpu.max", "500000 50000");
  EXPECT_EQ(cores("0::/a\n"), 10);
}

TEST_F(ControlGroupsTest, CoresAreTheLeastOfAllGroupsAbove) {
  write("a/cpu.max", "300000 100000");
  write("a/b/cpu.max", "max 100000");
  write("a/b/c/cpu.max", "700000 100000");
  EXPECT_EQ(cores("0::/a/b/c\n"), 3);
  EXPECT_EQ(cores("0::/d/e\n"), no_quota);
  // In a container the group itself is mounted at the root.
  write("cpu.max", "200000 100000");
  EXPECT_EQ(cores("0::/d/e\n"), 2);
}

TEST_F(ControlGroupsTest, CoresKnowVersionOne) {
  write("cpu,cpuacct/a/cpu.cfs_quota_us", "400000");
  write("cpu,cpuacct/a/cpu.cfs_period_us", "100000");
  EXPECT_EQ(cores("3:memory:/a\n4:cpu,cpuacct:/a\n0::/\n"), 4);
  EXPECT_EQ(cores("3:memory:/a\n4:cpuset:/a\n"), no_quota);
  EXPECT_EQ(cores("no colon\n4:cpu\n"), no_quota);
}

TEST_F(ControlGroupsTest, MemoryIsFreeWithoutALimit) {
  EXPECT_EQ(memory(""), endless);
  EXPECT_EQ(memory("0::/a\n"), endless);
  write("a/memory.max", "max");
  write("a/memory.high", "max");
  write("a/memory.current", "5000");
  EXPECT_EQ(memory("0::/a\n"), endless);
  // What version 1 writes for none.
  write("memory/a/memory.limit_in_bytes", "9223372036854771712");
  write("memory/a/memory.usage_in_bytes", "5000");
  EXPECT_GT(memory("4:memory:/a\n"), 9e18);
}

TEST_F(ControlGroupsTest, MemoryIsTheLimitLessWhatIsTaken) {
  write("a/memory.max", "900000");
  write("a/memory.current", "100000");
  EXPECT_EQ(memory("0::/a\n"), 800000);
  // Files held in memory can be dropped; those that programs share cannot.
  write("a/memory.stat",
        "anon 1000\nfile 60000\nshmem 20000\ninactive_file 30000\nactive_file 10000");
  EXPECT_EQ(memory("0::/a\n"), 840000);
  write("a/memory.high", "500000");
  EXPECT_EQ(memory("0::/a\n"), 440000);
  write("a/memory.current", "950000");
  EXPECT_EQ(memory("0::/a\n"), 0);
  write("a/memory.current", "35000");
  EXPECT_EQ(memory("0::/a\n"), 500000);
}

TEST_F(ControlGroupsTest, MemoryIsTheLeastOfAllGroupsAbove) {
  write("a/memory.max", "3000");
  write("a/memory.current", "2500");
  write("a/b/memory.max", "max");
  write("a/b/memory.current", "2400");
  write("a/b/c/memory.high", "700");
  write("a/b/c/memory.current", "100");
  EXPECT_EQ(memory("0::/a/b/c\n"), 500);
  write("a/memory.current", "1000");
  EXPECT_EQ(memory("0::/a/b/c\n"), 600);
  // In a container the group itself is mounted at the root.
  write("memory.max", "200");
  EXPECT_EQ(memory("0::/d/e\n"), 200);
  // What is above where the groups are mounted belongs to another.
  write("e/memory.max", "100");
  write("tree/memory.current", "1");
  EXPECT_EQ(memory_by_limits({"0::/../e\n", root_ / "tree"}), endless);
}

TEST_F(ControlGroupsTest, MemoryKnowsVersionOne) {
  write("memory/a/memory.limit_in_bytes", "8000");
  write("memory/a/memory.usage_in_bytes", "3000");
  write("memory/a/b/memory.limit_in_bytes", "6000");
  write("memory/a/b/memory.usage_in_bytes", "2000");
  const std::string names = "5:cpu,cpuacct:/x\n4:memory:/a/b\n0::/\n";
  EXPECT_EQ(memory(names), 4000);
  // Of the group and those below it: what files take is there under another name.
  write("memory/a/b/memory.stat",
        "inactive_file 1\ntotal_inactive_file 300\ntotal_active_file 200");
  EXPECT_EQ(memory(names), 4500);
  // A limit of a group that a container does not see.
  write("memory/a/b/memory.stat", "hierarchical_memory_limit 2600");
  EXPECT_EQ(memory(names), 600);
  EXPECT_EQ(memory("5:cpu,cpuacct:/a\n"), endless);
}

TEST_F(ControlGroupsTest, MemoryKnowsBothVersionsSideBySide) {
  write("memory/a/memory.limit_in_bytes", "8000");
  write("unified/s/memory.max", "5000");
  EXPECT_EQ(memory("4:memory:/a\n0::/s\n"), 5000);
  EXPECT_EQ(memory("4:memory:/a\n0::/t\n"), 8000);
}

// The files that this very process has, if any, are read the same way.
TEST_F(ControlGroupsTest, OfThisProcessCanBeAsked) {
  EXPECT_GE(cores_by_quota(own_groups()), 1);
  EXPECT_GT(memory_by_limits(own_groups()), 0.0);
}

}  // namespace
}  // namespace bounce
