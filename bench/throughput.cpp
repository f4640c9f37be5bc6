// Throughput of the kernels on Example 2, in double precision.
//
// Each repetition of a row takes turns: a batch of the oracle (-O3 -march=native), a batch of the
// row, a batch of the oracle with -Ofast. Ratios are made turn by turn, so a clock that swings does
// not reach them; a row is the median of its turns. Before it is timed a row runs 1000 steps beside
// the oracle; if it is off by more than rounding, it is an error and not a time.
//
// The port limit is the time that the kernel's multiplications and multiply-adds alone would take
// at the rate measured in the same turn; a row of one thread says which part of it is reached.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/multiply_add_rate.hpp"
#include "driver/origin.hpp"
#include "driver/scene_file.hpp"
#include "kernels/stepping/plan.hpp"
#include "verify/oracle.hpp"

namespace bounce {

namespace native {
void run_listing(Listing& ball, std::span<const Wall> walls, std::int64_t steps);
}
namespace fast_math {
void run_listing(Listing& ball, std::span<const Wall> walls, std::int64_t steps);
}

namespace {

constexpr int turns = 7;  // a repetition; bench.sh takes 15 of each row, interleaved
constexpr std::int64_t oracle_batch = 500;  // steps, some 5 ms
constexpr std::int64_t checked_steps = 1000;
// Two runs that round each position to half an ULP of 16 cm may part by one (3.6e-15 cm) a step.
constexpr double allowed_difference = checked_steps * 3.6e-15;  // cm

const Scene& scene() {
  static const Scene example = SceneFile::find("example-2").scene();
  return example;
}

const Problem& problem() {
  static const Problem made = make_problem(scene());
  return made;
}

double largest_difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]);
    if (!(d <= largest)) largest = d;
  }
  return largest;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// What a row times: balls that are stepped, all by the same number of steps.
class Subject {
 public:
  virtual ~Subject() = default;
  virtual void advance(std::int64_t steps) = 0;
  [[nodiscard]] virtual std::vector<State> states() const = 0;
  [[nodiscard]] virtual std::int64_t balls() const { return 1; }
  /// How its steps are taken; no plan, or more threads than one: no port limit.
  [[nodiscard]] virtual const Plan* plan() const { return nullptr; }
};

class OracleSubject final : public Subject {
 public:
  explicit OracleSubject(RunListing run) : oracle_(scene(), problem().initial, run) {}
  void advance(std::int64_t steps) override { oracle_.step(steps); }
  [[nodiscard]] std::vector<State> states() const override { return {oracle_.state()}; }

 private:
  Oracle oracle_;
};

class KernelSubject final : public Subject {
 public:
  KernelSubject(const std::string& kernel, const std::string& vector, int threads) {
    PlanRequest request;
    request.kernel = kernel;
    request.vector = vector;
    request.threads = threads;
    plan_ = make_plan(problem(), request);
    stepper_ = make_stepper(problem(), plan_);
  }
  void advance(std::int64_t steps) override { stepper_->advance(steps); }
  [[nodiscard]] std::vector<State> states() const override { return {stepper_->state()}; }
  [[nodiscard]] const Plan* plan() const override { return &plan_; }

 private:
  Plan plan_;
  std::unique_ptr<Stepper> stepper_;
};

// Independent balls, dealt to threads.
class ManySubject final : public Subject {
 public:
  ManySubject(const std::string& kernel, const std::string& vector, int balls, int threads)
      : threads_(threads) {
    for (int i = 0; i < balls; ++i) balls_.emplace_back(kernel, vector, 1);
  }
  void advance(std::int64_t steps) override {
#pragma omp parallel for num_threads(threads_) schedule(static)
    // NOLINTNEXTLINE(modernize-loop-convert): dealt to threads by index
    for (std::size_t i = 0; i < balls_.size(); ++i) balls_[i].advance(steps);
  }
  [[nodiscard]] std::vector<State> states() const override {
    std::vector<State> all;
    for (const KernelSubject& ball : balls_) all.push_back(ball.states().front());
    return all;
  }
  [[nodiscard]] std::int64_t balls() const override {
    return static_cast<std::int64_t>(balls_.size());
  }

 private:
  std::vector<KernelSubject> balls_;
  int threads_;
};

using MakeSubject = std::function<std::unique_ptr<Subject>()>;

double difference_from_oracle(const MakeSubject& make) {
  Oracle oracle(scene(), problem().initial);
  oracle.step(checked_steps);
  const auto subject = make();
  subject->advance(checked_steps);
  double largest = 0.0;
  for (const State& state : subject->states()) {
    const double d = largest_difference(state, oracle.state());
    if (!(d <= largest)) largest = d;
  }
  return largest;
}

double seconds_of(Subject& subject, std::int64_t steps) {
  const auto start = std::chrono::steady_clock::now();
  subject.advance(steps);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Seconds a step of one ball.
double time_step(Subject& subject, std::int64_t steps) {
  return seconds_of(subject, steps) / static_cast<double>(steps * subject.balls());
}

// A batch of about 5 ms, found by doubling.
std::int64_t batch_for(Subject& subject) {
  std::int64_t steps = 16;
  while (seconds_of(subject, steps) < 2.5e-3) steps *= 2;
  return steps;
}

// Seconds a step would take if the ports did nothing but multiply; 0 if nobody counted.
double port_limit(const Subject& subject) {
  const Plan* plan = subject.plan();
  if (plan == nullptr || plan->threads > 1 || plan->multiplications == 0.0) return 0.0;
  return plan->multiplications / multiply_add_rate(plan->vector);
}

void run_row(benchmark::State& state, const MakeSubject& make) {
  const double difference = difference_from_oracle(make);
  if (!(difference <= allowed_difference)) {
    state.SkipWithError("its state after 1000 steps is not the oracle's");
    return;
  }
  OracleSubject oracle(&native::run_listing), fast_math(&fast_math::run_listing);
  const auto subject = make();
  const std::int64_t batch = batch_for(*subject);
  std::vector<double> times, ratios, ratios_fast_math, parts;
  for (auto turn : state) {
    (void)turn;
    const double native_time = time_step(oracle, oracle_batch);
    const double limit = port_limit(*subject);
    const double time = time_step(*subject, batch);
    const double fast_math_time = time_step(fast_math, oracle_batch);
    times.push_back(time);
    parts.push_back(limit / time);
    ratios.push_back(native_time / time);
    ratios_fast_math.push_back(fast_math_time / time);
    state.SetIterationTime(time);
  }
  const double time = median(times);
  state.counters["ns_per_step"] = 1e9 * time;
  state.counters["particles_per_s"] = static_cast<double>(problem().initial.size()) / time;
  if (median(parts) > 0.0) state.counters["part_of_port_limit"] = median(parts);
  state.counters["bonds_per_s"] = static_cast<double>(problem().bonds.bonds()) / time;
  state.counters["x_oracle_O3"] = median(ratios);
  state.counters["x_oracle_Ofast"] = median(ratios_fast_math);
  state.counters["difference_cm"] = difference;
}

void add_row(const std::string& name, const MakeSubject& make) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [make](benchmark::State& state) { run_row(state, make); })
      ->UseManualTime()
      ->Iterations(turns)
      ->Unit(benchmark::kMicrosecond);
}

void add_rows() {
  const auto oracle = [](RunListing run) {
    return [run] { return std::make_unique<OracleSubject>(run); };
  };
  add_row("oracle -O3 -march=native/threads:1", oracle(&native::run_listing));
  add_row("oracle -Ofast -march=native/threads:1", oracle(&fast_math::run_listing));
  add_row("oracle no fma, as verify runs it/threads:1", oracle(&exact::run_listing));
  for (const VectorTarget target : available_vectors()) {
    const std::string vector(name_of(target));
    for (const char* kernel : {"strict", "csr", "ring"}) {
      for (const int threads : {1, 2}) {
        add_row(std::string(kernel) + " " + vector + "/threads:" + std::to_string(threads),
                [=] { return std::make_unique<KernelSubject>(kernel, vector, threads); });
      }
    }
    add_row("mirror " + vector + "/threads:1",
            [=] { return std::make_unique<KernelSubject>("mirror", vector, 1); });
    for (const int threads : {1, 2}) {
      add_row("64 balls ring " + vector + "/threads:" + std::to_string(threads),
              [=] { return std::make_unique<ManySubject>("ring", vector, 64, threads); });
    }
  }
}

}  // namespace
}  // namespace bounce

int main(int argc, char** argv) {
  const bounce::Origin origin = bounce::find_origin();
  benchmark::AddCustomContext("commit", origin.commit);
  benchmark::AddCustomContext("compiler", origin.compiler);
  benchmark::AddCustomContext("flags", origin.flags);
  benchmark::AddCustomContext("cpu", origin.cpu);
  benchmark::AddCustomContext("scene", "example-2");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  bounce::add_rows();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
