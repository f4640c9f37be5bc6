// The oracle's step built with -O3 -mfma -ffp-contract=fast: its pragma must keep fused
// multiply-add out.
#include <gtest/gtest.h>

#include "kernels/model/problem.hpp"
#include "verify/oracle/oracle.hpp"
#include "verify/tests/paper_scenes.hpp"
#include "verify/tests/same_state.hpp"

namespace bounce {

namespace resisting {  // with the file's own pragma
void run_listing(Listing& ball, std::span<const Wall> walls, std::int64_t steps);
}
namespace contracted {  // with leave to contract
void run_listing(Listing& ball, std::span<const Wall> walls, std::int64_t steps);
}

namespace {

State after_1000_steps(RunListing run) {
  const Scene scene = paper_scene(7);  // both kinds of wall
  Oracle oracle(scene, make_problem(scene).initial, run);
  oracle.step(1000);
  return oracle.state();
}

TEST(Contraction, KeptOutByThePragma) {
  if (!__builtin_cpu_supports("fma")) GTEST_SKIP() << "this processor has no fused multiply-add";
  const State expected = after_1000_steps(&exact::run_listing);
  EXPECT_TRUE(same_state(after_1000_steps(&resisting::run_listing), expected));
  EXPECT_FALSE(same_state(after_1000_steps(&contracted::run_listing), expected))
      << "these flags contract nothing, so this test shows nothing";
}

}  // namespace
}  // namespace bounce
