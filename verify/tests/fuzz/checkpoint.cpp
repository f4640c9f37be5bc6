// Checkpoints that bounce resume reads. A checksum keeps chance away from what is behind it, so it is
// made right here: what an input ends with is taken for its number of words and its checksum.
#include <cstring>

#include "driver/run/checkpoint.hpp"
#include "driver/run/run_gauges.hpp"
#include "verify/tests/fuzz/fuzz_target.hpp"
#include "verify/watch/margin.hpp"

namespace {

// A ball of three particles.
bounce::Problem small_problem() {
  bounce::Scene scene;
  scene.ball.radii = {1.0};
  scene.ball.per_ring = 3;
  scene.ball.rounding = bounce::Rounding::none;
  scene.law.rest = bounce::Rest::geometry;
  scene.walls = {bounce::Wall{}};
  return bounce::make_problem(scene);
}

// Reads what a run would.
void read_numbers(const bounce::Checkpoint& checkpoint) {
  static const bounce::Problem problem = small_problem();
  bounce::RunGauges gauges(problem, bounce::BounceGauge(problem, problem.step, {}), 1.0, true);
  bounce::MarginGauge margin(problem);
  bounce::Snapshot now, good;
  try {
    bounce::WordReader words(checkpoint.words);
    words(now, good, gauges, margin);
    words.finish();
  } catch (const bounce::WordsError&) {  // named by bounce resume
  }
}

void read_sealed(std::string bytes) {
  bytes.resize(bytes.size() / 8 * 8);
  bounce::seal_checkpoint(bytes);
  read_numbers(bounce::read_checkpoint(bytes, "input", true));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return bounce::fuzz(data, size, read_sealed);
}
