// The quota of control groups, read from files as the kernel writes them.
#include "driver/world/cores.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace bounce {
namespace {

namespace fs = std::filesystem;

class CoresTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "bounce-cores-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    root_ = name;
  }
  void TearDown() override { fs::remove_all(root_); }
  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text << "\n";
  }
  fs::path root_;
};

TEST_F(CoresTest, AreFreeWithoutAQuota) {
  EXPECT_EQ(cores_by_quota("", root_), no_quota);
  EXPECT_EQ(cores_by_quota("0::/a\n", root_), no_quota);
  write("cpu.max", "max 100000");
  write("a/cpu.max", "max 100000");
  EXPECT_EQ(cores_by_quota("0::/a\n", root_), no_quota);
  write("cpu/a/cpu.cfs_quota_us", "-1");
  write("cpu/a/cpu.cfs_period_us", "100000");
  EXPECT_EQ(cores_by_quota("4:cpu,cpuacct:/a\n", root_), no_quota);
}

TEST_F(CoresTest, AreRoundedDownButNeverNone) {
  write("a/cpu.max", "250000 100000");
  EXPECT_EQ(cores_by_quota("0::/a\n", root_), 2);
  write("a/cpu.max", "50000 100000");
  EXPECT_EQ(cores_by_quota("0::/a\n", root_), 1);
  write("a/cpu.max", "500000 50000");
  EXPECT_EQ(cores_by_quota("0::/a\n", root_), 10);
}

TEST_F(CoresTest, AreTheLeastOfAllGroupsAbove) {
  write("a/cpu.max", "300000 100000");
  write("a/b/cpu.max", "max 100000");
  write("a/b/c/cpu.max", "700000 100000");
  EXPECT_EQ(cores_by_quota("0::/a/b/c\n", root_), 3);
  EXPECT_EQ(cores_by_quota("0::/d/e\n", root_), no_quota);
  // In a container the group itself is mounted at the root.
  write("cpu.max", "200000 100000");
  EXPECT_EQ(cores_by_quota("0::/d/e\n", root_), 2);
}

TEST_F(CoresTest, KnowVersionOne) {
  write("cpu,cpuacct/a/cpu.cfs_quota_us", "400000");
  write("cpu,cpuacct/a/cpu.cfs_period_us", "100000");
  EXPECT_EQ(cores_by_quota("3:memory:/a\n4:cpu,cpuacct:/a\n0::/\n", root_), 4);
  EXPECT_EQ(cores_by_quota("3:memory:/a\n4:cpuset:/a\n", root_), no_quota);
  EXPECT_EQ(cores_by_quota("no colon\n4:cpu\n", root_), no_quota);
}

}  // namespace
}  // namespace bounce
