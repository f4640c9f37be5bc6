// The file of a checkpoint: whole, or refused with the reason.
#include "driver/run/checkpoint.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "driver/output/run_directory.hpp"
#include "driver/world/input_error.hpp"
#include "driver/world/origin.hpp"
#include "verify/watch/ledger.hpp"
#include "verify/watch/margin.hpp"

namespace bounce {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class CheckpointTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "bounce-test-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    const Origin origin = find_origin();
    head_.version = origin.version;
    head_.commit = origin.commit;
    head_.settings.command = "bounce run \"\xff\" \n";
    head_.settings.request = {"ring", "avx2", 3};
    head_.settings.resumed = {7, 9};
    head_.settings.ledger = true;
    head_.step = 123;
    head_.time = 0.1;
    head_.scene = 0xfedcba9876543210U;
    head_.start = 1;
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(double value) {
    write_checkpoint(
        folder_, head_, [value](WordWriter& words) { words(std::vector<double>(20, value)); },
        true);
  }
  [[nodiscard]] std::string bytes() const { return contents(folder_ / checkpoint_name); }
  // What reading says.
  static std::string refusal(const std::string& bytes) {
    try {
      read_checkpoint(bytes, "c", false);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
  CheckpointHead head_;
};

TEST_F(CheckpointTest, HoldsWhatWasWritten) {
  write(-0.0);
  const Checkpoint read = read_checkpoint(bytes(), "c", false);
  EXPECT_EQ(read.head.settings.request.kernel, "ring");
  EXPECT_EQ(read.head.settings.request.vector, "avx2");
  EXPECT_EQ(read.head.settings.request.threads, 3);
  EXPECT_EQ(read.head.settings.resumed, (std::vector<std::int64_t>{7, 9}));
  EXPECT_TRUE(read.head.settings.ledger);
  EXPECT_FALSE(read.head.settings.listing_frames);
  EXPECT_EQ(read.head.step, 123);
  EXPECT_EQ(read.head.time, 0.1);
  EXPECT_EQ(read.head.scene, 0xfedcba9876543210U);
  EXPECT_EQ(read.head.start, 1U);
  std::vector<double> values;
  WordReader words(read.words);
  words(values);
  words.finish();
  ASSERT_EQ(values.size(), 20U);
  EXPECT_TRUE(std::signbit(values[19]));
}

TEST_F(CheckpointTest, TheOneBeforeIsKeptAndNothingElse) {
  write(1.0);
  const std::string first = bytes();
  write(2.0);
  EXPECT_EQ(contents(folder_ / "checkpoint.before"), first);
  write(3.0);
  EXPECT_NE(contents(folder_ / "checkpoint.before"), first);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
  fs::remove(folder_ / checkpoint_name);
  EXPECT_EQ(load_checkpoint(folder_, true, false).head.step, 123);
  EXPECT_THROW(load_checkpoint(folder_, false, false), InputError);
}

TEST_F(CheckpointTest, CutAnywhereItIsRefused) {
  write(1.0);
  const std::string whole = bytes();
  ASSERT_EQ(refusal(whole), "");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(refusal(whole.substr(0, size)), "") << size;
  }
  EXPECT_NE(refusal(whole.substr(0, whole.size() - 8)).find("not whole"), std::string::npos);
  EXPECT_NE(refusal(whole + whole.substr(0, 8)).find("not whole"), std::string::npos);
}

TEST_F(CheckpointTest, AnyBitThatIsFlippedIsSeen) {
  write(1.0);
  const std::string whole = bytes();
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string flipped = whole;
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << bit));
      EXPECT_NE(refusal(flipped), "") << "byte " << at << ", bit " << bit;
    }
  }
  std::string flipped = whole;
  flipped[whole.size() - 40] ^= 1;
  EXPECT_NE(refusal(flipped).find("its checksum"), std::string::npos) << refusal(flipped);
}

TEST_F(CheckpointTest, ForeignNewerAndOtherProgramsAreNamed) {
  EXPECT_EQ(refusal(""), "c: is no checkpoint of bounce");
  EXPECT_EQ(refusal("i,x,y,vx,vy\n"), "c: is no checkpoint of bounce");
  write(1.0);
  std::string newer = bytes();
  newer.replace(0, 19, "bounce checkpoint 2");
  EXPECT_NE(refusal(newer).find("in format 2; this program reads format 1"), std::string::npos)
      << refusal(newer);
  head_.commit = "0123456789ab";
  write(1.0);
  EXPECT_NE(refusal(bytes()).find("(commit 0123456789ab)"), std::string::npos) << refusal(bytes());
  EXPECT_EQ(read_checkpoint(bytes(), "c", true).head.commit, "0123456789ab");
}

TEST_F(CheckpointTest, AHeadThatIsNoneIsNamedBriefly) {
  std::string bytes = "bounce checkpoint 1\n\"" + std::string(3986, '\xa6') + "\n";
  ASSERT_EQ(bytes.size() % 8, 0U);
  bytes.resize(bytes.size() + 16);
  seal_checkpoint(bytes);
  EXPECT_NE(refusal(bytes).find("what it says of its run cannot be read"), std::string::npos);
  EXPECT_LT(refusal(bytes).size(), 1500U);  // 200 bytes, each shown as \xa6
  EXPECT_LT(refusal("bounce checkpoint " + std::string(4000, '\xa6')).size(), 300U);
}

TEST_F(CheckpointTest, AScenesHashKnowsAllButItsEnd) {
  Scene scene;
  const std::uint64_t hash = hash_of(scene);
  scene.time.end = 2.0;
  EXPECT_EQ(hash_of(scene), hash);
  scene.law.elasticity = std::nextafter(scene.law.elasticity, 0.0);
  EXPECT_NE(hash_of(scene), hash);
}

// Words that are not what is asked for: an error, and no list longer than what is there.
TEST(WordsTest, WordsThatDoNotFitAreAnError) {
  const auto reading = [](std::vector<std::uint64_t> words, auto value) {
    WordReader reader(words);
    reader(value);
    reader.finish();
  };
  EXPECT_NO_THROW(reading({2, 5, 6}, std::vector<std::int64_t>{}));
  EXPECT_THROW(reading({3, 5, 6}, std::vector<std::int64_t>{}), WordsError);
  EXPECT_THROW(reading({std::uint64_t{1} << 60U, 5}, std::vector<double>{}), WordsError);
  EXPECT_THROW(reading({2}, true), WordsError);
  EXPECT_THROW(reading({1, 1}, true), WordsError);
  EXPECT_THROW(reading({}, 1.0), WordsError);
  EXPECT_THROW(reading({0, 1}, std::optional<double>{}), WordsError);
  EXPECT_THROW(reading({1}, State{}), WordsError);
}

}  // namespace
}  // namespace bounce
