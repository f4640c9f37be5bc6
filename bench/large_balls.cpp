// What a particle-step costs in balls of 360 to 10 million particles.
//
// Three rings with the paper's bonds: the radii grow with the number of particles, so that
// neighbours along a ring stand as they do in the paper's ball, and E, step and law are Example
// 2's. Each turn of a row times, one right after the other: the paper's ball of 360 by one thread,
// the row's ball as the plan runs it, the same kernel made to sweep through memory once a stage,
// and the rate at which memory is read and written in place. Ratios are made turn by turn; a row is
// the median of its turns. Before it is timed, both ways of walking must agree to the last bit.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bench/memory_rate.hpp"
#include "bench/plain_sweep.hpp"
#include "bench/run_rows.hpp"
#include "driver/world/limits.hpp"
#include "kernels/plan/plan.hpp"

namespace bounce {
namespace {

constexpr int turns = 9;
constexpr std::int64_t steps_at_once = 16;  // a visit's stages: batches are whole visits
constexpr double batch_seconds = 20e-3;
constexpr double state_traffic = 2.0 * 32.0;  // bytes a particle-step of a sweep: in and out
constexpr std::size_t rate_bytes = std::size_t{256} << 20;
constexpr double bytes_a_particle = 5.0 * 32.0;  // start, two steppers, two states to compare

Scene ball_of(std::int64_t particles) {
  Scene scene;
  scene.ball.per_ring = particles / 3;
  const double scale = static_cast<double>(scene.ball.per_ring) / 120.0;
  scene.ball.radii = {5.0 * scale, 5.0 * scale + 1.0, 5.0 * scale + 2.0};
  scene.ball.centre = {0.0, scene.ball.radii.back() + 1.0};
  scene.ball.rounding = Rounding::none;
  scene.law.rest = Rest::geometry;
  scene.walls = {Wall{}};
  return scene;
}

std::unique_ptr<Stepper> stepper_of(const Problem& problem, int threads) {
  PlanRequest request;
  request.kernel = "ring";
  request.threads = threads;
  return make_stepper(problem, request);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// A ball being stepped, and how many steps fill a batch.
class Subject {
 public:
  Subject(std::unique_ptr<Stepper> stepper, double particles)
      : stepper_(std::move(stepper)), particles_(particles) {}

  /// Finds the batch; call once, before time().
  void find_batch() {
    while (seconds_of(batch_) < batch_seconds) batch_ *= 2;
  }
  /// Seconds a particle-step, now.
  double time() { return seconds_of(batch_) / (static_cast<double>(batch_) * particles_); }
  [[nodiscard]] Stepper& stepper() { return *stepper_; }

 private:
  double seconds_of(std::int64_t steps) {
    const auto start = std::chrono::steady_clock::now();
    stepper_->advance(steps);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  std::unique_ptr<Stepper> stepper_;
  double particles_;
  std::int64_t batch_ = steps_at_once;
};

void run_row(benchmark::State& state, std::int64_t particles, int threads) {
  const auto count = static_cast<double>(particles);
  if (bytes_a_particle * count + rate_bytes > available_memory()) {
    state.SkipWithError("memory cannot hold it");
    return;
  }
  const auto built = std::chrono::steady_clock::now();
  Problem problem = make_problem(ball_of(particles));
  const std::chrono::duration<double> build_time = std::chrono::steady_clock::now() - built;
  Subject tiles(stepper_of(problem, threads), count);
  Subject sweep(make_plain_sweep(problem, choose_vector("auto"), threads), count);
  problem.initial = State();
  Subject papers(stepper_of(make_problem(ball_of(360)), 1), 360.0);
  MemoryRate memory(rate_bytes);
  tiles.stepper().advance(steps_at_once + 3);
  sweep.stepper().advance(steps_at_once + 3);
  if (state_hash(tiles.stepper().state()) != state_hash(sweep.stepper().state())) {
    state.SkipWithError("its state is not the plain sweep's");
    return;
  }
  for (Subject* subject : {&papers, &tiles, &sweep}) subject->find_batch();
  std::vector<double> times, to_papers, sweeps, sweep_to_papers, rates, limits;
  for (auto turn : state) {
    (void)turn;
    const double papers_time = papers.time();
    const double time = tiles.time();
    const double sweep_time = sweep.time();
    const double rate = memory.measure(threads);
    times.push_back(time);
    to_papers.push_back(time / papers_time);
    sweeps.push_back(sweep_time);
    sweep_to_papers.push_back(sweep_time / papers_time);
    rates.push_back(rate);
    limits.push_back(state_traffic / rate);
    state.SetIterationTime(time);
  }
  state.counters["particles"] = count;
  state.counters["build_s"] = build_time.count();
  state.counters["ns_per_particle_step"] = 1e9 * median(times);
  state.counters["x_papers_ball"] = median(to_papers);
  state.counters["sweep_ns_per_particle_step"] = 1e9 * median(sweeps);
  state.counters["sweep_x_papers_ball"] = median(sweep_to_papers);
  state.counters["memory_bytes_per_s"] = median(rates);
  state.counters["memory_ns_per_particle_step"] = 1e9 * median(limits);
}

void add_rows() {
  for (const std::int64_t particles : {360, 3600, 36000, 360000, 3600000, 10000200}) {
    for (const int threads : {1, 2}) {
      const std::string name =
          "particles:" + std::to_string(particles) + "/threads:" + std::to_string(threads);
      benchmark::RegisterBenchmark(
          name.c_str(), [=](benchmark::State& state) { run_row(state, particles, threads); })
          ->UseManualTime()
          ->Iterations(turns)
          ->Unit(benchmark::kNanosecond);
    }
  }
}

}  // namespace
}  // namespace bounce

int main(int argc, char** argv) {
  benchmark::AddCustomContext("turns", std::to_string(bounce::turns));
  return bounce::run_rows(argc, argv, bounce::add_rows);
}
