// The oracle against the listing compiled by a FORTRAN compiler (listing.f): the same bits after
// every run, from the same BALL.DAT. E = 16000 and g = 0.098 are written into the listing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <ios>
#include <random>
#include <sstream>
#include <string>

#include "kernels/model/problem.hpp"
#include "verify/oracle/oracle.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

// After the last, every particle has felt every other (sound crosses the ball in some 10 ms, that
// is 10 000 steps). The first see a sum of forces in another order, which changes the last bit of
// small velocities only and is rounded away when these have grown.
constexpr int looks[] = {1, 10, 100, 12000};

// A run of the FORTRAN program in a folder of its own.
class FortranRun {
 public:
  explicit FortranRun(const State& start) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::path(testing::TempDir()) / ("bounce_fortran_" + std::string(test->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::ofstream file(folder_ / "BALL.DAT");
    write_listing_frame(file, start);
  }
  ~FortranRun() { std::filesystem::remove_all(folder_); }
  FortranRun(const FortranRun&) = delete;
  FortranRun& operator=(const FortranRun&) = delete;

  [[nodiscard]] State start() const {
    std::ifstream file(folder_ / "BALL.DAT");
    return read_listing_frame(file);
  }
  [[nodiscard]] int run(int count) const {
    const std::string command =
        "cd '" + folder_.string() + "' && '" BOUNCE_LISTING_PROGRAM "' " + std::to_string(count);
    return std::system(command.c_str());
  }
  [[nodiscard]] State bits() const {
    std::ifstream file(folder_ / "BITS.DAT");
    State state;
    const auto next = [&file] {
      std::uint64_t word = 0;
      file >> std::hex >> word;
      return std::bit_cast<double>(word);
    };
    for (int i = 0; i < 360; ++i) {
      state.x.push_back(next());
      state.y.push_back(next());
      state.vx.push_back(next());
      state.vy.push_back(next());
    }
    EXPECT_TRUE(static_cast<bool>(file)) << "BITS.DAT is not whole";
    return state;
  }
  [[nodiscard]] std::string frame() const {
    std::ifstream file(folder_ / "BALL.OUT");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

 private:
  std::filesystem::path folder_;
};

// What a reflection leaves behind: two exact zeros.
std::int64_t just_reflected(const Listing& b) {
  std::int64_t count = 0;
  for (int i = 1; i <= 360; ++i) count += b.vx[i] == 0.0 && b.vy[i] == 0.0 && b.y[i] < 1e-3;
  return count;
}

// `least_reflected`: reflections that the run must contain to be worth its name.
void expect_same_bits(const State& start, std::int64_t least_reflected) {
  const FortranRun fortran(start);
  Oracle oracle(paper_scene(2), fortran.start());
  std::int64_t reflected = 0;
  int step = 0;
  for (const int look : looks) {
    SCOPED_TRACE("after " + std::to_string(look) + " steps");
    ASSERT_EQ(fortran.run(look), 0);
    for (; step < look; ++step) {
      oracle.step(1);
      reflected += just_reflected(oracle.listing());
    }
    const State expected = fortran.bits();
    const State now = oracle.state();
    EXPECT_TRUE(is_finite(now));
    EXPECT_TRUE(same_state(now, expected));
    std::ostringstream frame;
    write_listing_frame(frame, now);
    EXPECT_EQ(frame.str(), fortran.frame());
  }
  EXPECT_GE(reflected, least_reflected);
}

TEST(Fortran, SameBitsFromRest) { expect_same_bits(make_problem(paper_scene(2)).initial, 0); }

// Falls at 200 cm/s from just above the axis: many particles are reflected, the lowest for
// thousands of steps.
TEST(Fortran, SameBitsOnTheWall) {
  Scene scene = paper_scene(2);
  scene.ball.centre = {0.0, 7.01};
  scene.ball.velocity = {40.0, -200.0};
  expect_same_bits(make_problem(scene).initial, 1000);
}

// No symmetry left, every bond strained by its own amount: no sum of forces is small by luck.
TEST(Fortran, SameBitsFromDisorder) {
  Scene scene = paper_scene(2);
  scene.ball.centre = {1.0, 7.06};
  State start = make_problem(scene).initial;
  std::mt19937 random(360);
  std::uniform_real_distribution<double> shift(-0.05, 0.05);
  for (std::size_t i = 0; i < start.size(); ++i) {
    start.x[i] += shift(random);
    start.y[i] += shift(random);
  }
  expect_same_bits(start, 10);
}

}  // namespace
}  // namespace bounce
