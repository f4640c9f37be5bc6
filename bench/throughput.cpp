// Throughput of the kernels: most rows on Example 2, some on others of the paper's.
//
// Each repetition of a row takes turns: a batch of the oracle (-O3 -march=native), a batch of the
// row, a batch of the oracle with -Ofast. Ratios are made turn by turn, so a clock that swings does
// not reach them; a row is the median of its turns. Before it is timed a row runs 1000 steps beside
// the oracle; if it is off by more than rounding, it is an error and not a time.
//
// The port limit is the time that the kernel's multiplications and multiply-adds alone would take
// at the rate measured in the same turn; a row of one thread says which part of it is reached. A
// row of several threads on one ball says how long a hand-shake between two of them took meanwhile.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/hand_shake.hpp"
#include "bench/multiply_add_rate.hpp"
#include "bench/run_rows.hpp"
#include "bench/timing.hpp"
#include "driver/scene/scene_file.hpp"
#include "kernels/plan/plan.hpp"
#include "verify/oracle/oracle.hpp"

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

struct Case {
  std::string name;
  Scene scene;
  Problem problem;
};

const Case& case_of(const std::string& name) {
  static std::map<std::string, Case> cases;
  auto found = cases.find(name);
  if (found == cases.end()) {
    const Scene scene = SceneFile::find(name).scene();
    found = cases.emplace(name, Case{name, scene, make_problem(scene)}).first;
  }
  return found->second;
}

double largest_difference(const State& a, const State& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]);
    if (!(d <= largest)) largest = d;
  }
  return largest;
}

// Multiplications of whole vectors a step of one ball takes.
struct Counted {
  double multiplications;
  VectorTarget vector;
};

// What a row times: balls that are stepped, all by the same number of steps.
class Subject {
 public:
  virtual ~Subject() = default;
  virtual void advance(std::int64_t steps) = 0;
  [[nodiscard]] virtual std::vector<State> states() const = 0;
  [[nodiscard]] virtual std::int64_t balls() const { return 1; }
  /// For the port limit; nothing for several threads and for operations that nobody counted.
  [[nodiscard]] virtual std::optional<Counted> counted() const { return std::nullopt; }
  /// Threads that meet once a stage.
  [[nodiscard]] virtual int team() const { return 1; }
};

class OracleSubject final : public Subject {
 public:
  OracleSubject(const Case& of, RunListing run) : oracle_(of.scene, of.problem.initial, run) {}
  void advance(std::int64_t steps) override { oracle_.step(steps); }
  [[nodiscard]] std::vector<State> states() const override { return {oracle_.state()}; }

 private:
  Oracle oracle_;
};

PlanRequest request_of(const std::string& kernel, const std::string& vector, int threads) {
  PlanRequest request;
  request.kernel = kernel;
  request.vector = vector;
  request.threads = threads;
  request.more_threads_than_cores = true;  // a row's name says what runs
  return request;
}

class KernelSubject final : public Subject {
 public:
  KernelSubject(const Case& of, const PlanRequest& request)
      : plan_(make_plan(of.problem, request)), stepper_(plan_.make_stepper()) {}
  void advance(std::int64_t steps) override { stepper_->advance(steps); }
  [[nodiscard]] std::vector<State> states() const override { return {stepper_->state()}; }
  [[nodiscard]] std::optional<Counted> counted() const override {
    if (plan_.threads > 1 || plan_.multiplications == 0.0) return std::nullopt;
    return Counted{plan_.multiplications, plan_.vector};
  }
  [[nodiscard]] int team() const override { return plan_.threads; }

 private:
  Plan plan_;
  std::unique_ptr<Stepper> stepper_;
};

// Independent balls, one after another, dealt to threads.
class ManySubject final : public Subject {
 public:
  ManySubject(const Case& of, const std::string& vector, int balls, int threads)
      : threads_(threads) {
    for (int i = 0; i < balls; ++i) balls_.emplace_back(of, request_of("ring", vector, 1));
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

double difference_from_oracle(const Case& of, const MakeSubject& make) {
  Oracle oracle(of.scene, of.problem.initial);
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

// Seconds a step of one ball.
double time_step(Subject& subject, std::int64_t steps) {
  return seconds_of(subject, steps) / static_cast<double>(steps * subject.balls());
}

// Seconds a step would take if the ports did nothing but multiply; 0 if nobody counted.
double port_limit(const Subject& subject) {
  const std::optional<Counted> counted = subject.counted();
  return counted ? counted->multiplications / multiply_add_rate(counted->vector) : 0.0;
}

void run_row(benchmark::State& state, const Case& of, const MakeSubject& make) {
  const double difference = difference_from_oracle(of, make);
  if (!(difference <= allowed_difference)) {
    state.SkipWithError("its state after 1000 steps is not the oracle's");
    return;
  }
  OracleSubject oracle(of, &native::run_listing), fast_math(of, &fast_math::run_listing);
  const auto subject = make();
  const std::int64_t batch = batch_for(*subject, 2.5e-3);
  std::vector<double> times, ratios, ratios_fast_math, parts, hand_shakes;
  for (auto turn : state) {
    (void)turn;
    const double native_time = time_step(oracle, oracle_batch);
    const double limit = port_limit(*subject);
    if (subject->team() > 1) hand_shakes.push_back(hand_shake_time());
    const double time = time_step(*subject, batch);
    const double fast_math_time = time_step(fast_math, oracle_batch);
    times.push_back(time);
    parts.push_back(limit / time);
    ratios.push_back(native_time / time);
    ratios_fast_math.push_back(fast_math_time / time);
    state.SetIterationTime(time);
  }
  const double time = median(times);
  state.SetLabel(of.name);
  state.counters["ns_per_step"] = 1e9 * time;
  state.counters["particles_per_s"] = static_cast<double>(of.problem.initial.size()) / time;
  if (median(parts) > 0.0) state.counters["part_of_port_limit"] = median(parts);
  if (!hand_shakes.empty()) state.counters["hand_shake_ns"] = 1e9 * median(hand_shakes);
  state.counters["bonds_per_s"] = static_cast<double>(of.problem.bonds.bonds()) / time;
  state.counters["x_oracle_O3"] = median(ratios);
  state.counters["x_oracle_Ofast"] = median(ratios_fast_math);
  state.counters["difference_cm"] = difference;
}

void add_row(const std::string& name, const Case& of, const MakeSubject& make) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [&of, make](benchmark::State& state) { run_row(state, of, make); })
      ->UseManualTime()
      ->Iterations(turns)
      ->Unit(benchmark::kMicrosecond);
}

std::string with_threads(const std::string& name, int threads) {
  return name + "/threads:" + std::to_string(threads);
}

void add_kernel(const std::string& kernel, const std::string& vector, int threads,
                const std::string& scene = "example-2") {
  const Case& of = case_of(scene);
  const std::string where = scene == "example-2" ? "" : ", " + scene;
  const PlanRequest request = request_of(kernel, vector, threads);
  add_row(with_threads(kernel + " " + vector + where, threads), of,
          [&of, request] { return std::make_unique<KernelSubject>(of, request); });
}

bool runs(const Case& of, const PlanRequest& request) {
  try {
    static_cast<void>(make_plan(of.problem, request));
  } catch (const PlanError&) {
    return false;
  }
  return true;
}

// Every kernel that can step the ball.
void add_vector_rows(const std::string& vector) {
  const Case& of = case_of("example-2");
  for (const KernelEntry& entry : kernels()) {
    if (!runs(of, request_of(entry.name, vector, 1))) continue;
    for (const int threads : {1, 2}) add_kernel(entry.name, vector, threads);
  }
  add_kernel("ring", vector, 4);  // on two cores: it must not collapse
  for (const int threads : {1, 2}) add_kernel("mirror", vector, threads, "example-1");
  for (const int threads : {1, 2}) {
    add_row(with_threads("64 balls ring " + vector, threads), of, [&of, vector, threads] {
      return std::make_unique<ManySubject>(of, vector, 64, threads);
    });
  }
  add_kernel("ring", vector, 1, "example-5");  // sideways: no symmetry
}

void add_rows() {
  const auto add_oracle = [](const std::string& name, RunListing run) {
    const Case& of = case_of("example-2");
    add_row(with_threads(name, 1), of,
            [&of, run] { return std::make_unique<OracleSubject>(of, run); });
  };
  add_oracle("oracle -O3 -march=native", &native::run_listing);
  add_oracle("oracle -Ofast -march=native", &fast_math::run_listing);
  add_oracle("oracle without fma", &exact::run_listing);
  for (const VectorTarget target : available_vectors())
    add_vector_rows(std::string(name_of(target)));
  add_kernel("auto", "auto", 0, "example-1");  // what a user gets who asks for nothing
}

}  // namespace
}  // namespace bounce

int main(int argc, char** argv) { return bounce::run_rows(argc, argv, bounce::add_rows); }
