// The hash of a state sees every bit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "kernels/model/problem.hpp"
#include "kernels/model/state.hpp"
#include "verify/tests/paper_scenes.hpp"

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

}  // namespace
}  // namespace bounce
