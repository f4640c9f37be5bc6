// The hash of a state sees every bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "kernels/model/problem.hpp"
#include "kernels/model/state.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {
namespace {

TEST(StateHash, SeesOneBit) {
  State state(4);
  const std::uint64_t before = state_hash(state);
  state.vy[3] = std::nextafter(0.0, 1.0);
  EXPECT_NE(state_hash(state), before);
  state.vy[3] = -0.0;
  EXPECT_NE(state_hash(state), before);
}

TEST(State, HashSeesEveryBit) {
  const State state = make_problem(paper_scene(2)).initial;
  for (auto member : {&State::x, &State::y, &State::vx, &State::vy}) {
    State other = state;
    (other.*member)[359] = std::nextafter((other.*member)[359], 100.0);
    EXPECT_NE(state_hash(other), state_hash(state));
  }
  State negative = state;
  negative.vx[0] = -0.0;
  EXPECT_NE(state_hash(negative), state_hash(state));
  EXPECT_EQ(state_hash(State(state)), state_hash(state));
}

// A failure tells the first particle that differs, and by how much.
TEST(SameState, SaysWhereAndByHowMuch) {
  State one(3), other(3);
  one.x = other.x = {1.0, 2.0, 3.0};
  EXPECT_TRUE(same_state(one, other));
  other.x[1] = 2.0 + 3 * 0x1p-51;
  other.vy[1] = 0.5;
  other.vx[2] = 0.25;
  const auto result = same_state(one, other);
  EXPECT_FALSE(result);
  const std::string text = result.message();
  for (const char* part : {"x = 2 and 2.0000000000000013 (3 ULP)", "vy = 0 and 0.5",
                           " of particle 2; 2 of 3 particles differ, by up to 0.5"}) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }
  other = one;
  other.y[0] = -0.0;
  EXPECT_FALSE(same_state(one, other));
  other.y[0] = std::nan("");
  EXPECT_NE(std::string(same_state(one, other).message()).find("by up to nan"), std::string::npos);
  EXPECT_FALSE(same_state(one, State(2)));
}

}  // namespace
}  // namespace bounce
