#include "verify/watch/booking_stepper.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/model/powers.hpp"
#include "kernels/model/wall_rule.hpp"
#include "verify/watch/monitor.hpp"
#include "verify/watch/words.hpp"

namespace bounce {
namespace {

constexpr std::int64_t longest_block = 4096;  // steps: far more than saving and comparing costs
// Roundings of a mirrored coordinate: distance, twice it, product and difference, for each wall.
constexpr double rule_roundings = 16.0;

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return same_bits(x, y); });
}

bool same_bits(const State& a, const State& b) {
  return same_bits(a.y, b.y) && same_bits(a.vy, b.vy) && same_bits(a.x, b.x) &&
         same_bits(a.vx, b.vx);
}

struct Particle {
  double x, y, vx, vy;
};

Particle particle_of(const State& s, std::size_t i) { return {s.x[i], s.y[i], s.vx[i], s.vy[i]}; }

bool same_bits(const Particle& a, const Particle& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.vx, b.vx) &&
         same_bits(a.vy, b.vy);
}

// What rounding may do to a distance from the wall, cm.
double distance_rounding(const Wall& wall, const Particle& p) {
  return rule_roundings * unit_roundoff * (std::abs(p.x) + std::abs(p.y) + std::abs(wall.offset));
}

// The wall's rule for a particle that is behind it after a drift of `drift` (s).
Particle mirrored(const Wall& wall, double drift, const Particle& p) {
  const Motion after = after_wall(wall, drift, {{p.x, p.y}, {p.vx, p.vy}});
  return {after.position.x, after.position.y, after.velocity.x, after.velocity.y};
}

// What rounding may do to where the resolved rule lets a particle cross a wall, cm along the wall:
// the distance's rounding over the slope of its path, at most all of the drift.
double crossing_rounding(const Wall& wall, double drift, const Particle& p) {
  if (wall.contact != Contact::resolved) return 0.0;
  const double normal = std::abs(wall.normal.x * p.vx + wall.normal.y * p.vy);
  const double along = std::abs(wall.normal.x * p.vy - wall.normal.y * p.vx);
  const double slope = distance_rounding(wall, p) / (std::abs(drift) * normal);
  return std::abs(drift) * along * (slope < 1.0 ? slope : 1.0);
}

// One mirroring of a particle at one wall, and where it leads.
struct Mirroring {
  std::size_t wall;
  Particle after;
};

// What the walls did to one particle, as the rule has it.
struct Verdict {
  std::vector<Mirroring> mirrorings;
  bool missed = false, otherwise = false;
};

bool is_near(const Particle& a, const Particle& b, const Particle& sizes, double length,
             double crossing) {
  const double place =
      crossing + rule_roundings * unit_roundoff * (std::abs(sizes.x) + std::abs(sizes.y) + length);
  const double speed = rule_roundings * unit_roundoff * (std::abs(sizes.vx) + std::abs(sizes.vy));
  return std::abs(a.x - b.x) <= place && std::abs(a.y - b.y) <= place &&
         std::abs(a.vx - b.vx) <= speed && std::abs(a.vy - b.vy) <= speed;
}

// A particle within rounding of a wall may be mirrored or not; else the rule decides.
Verdict judge(const std::vector<Wall>& walls, double drift, const Particle& before,
              const Particle& after) {
  Verdict verdict;
  const bool changed = !same_bits(before, after);
  if (drift < 0.0) {  // it meets no wall
    verdict.otherwise = changed;
    return verdict;
  }
  Particle now = before;
  double offsets = 0.0, crossing = 0.0;
  bool borderline = false;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const double distance = wall_distance(walls[w], now.x, now.y);
    const double rounding = distance_rounding(walls[w], now);
    offsets += std::abs(walls[w].offset);
    borderline = borderline || std::abs(distance) <= rounding;
    if (distance > rounding || (!changed && distance >= -rounding)) continue;
    crossing += crossing_rounding(walls[w], drift, now);
    now = mirrored(walls[w], drift, now);
    verdict.mirrorings.push_back({w, now});
  }
  if (!changed) {
    // Mirrored into the very same bits: a particle without velocity, at the wall.
    verdict.missed = !is_near(now, after, before, offsets, crossing) && !borderline;
    verdict.mirrorings.clear();
    return verdict;
  }
  verdict.otherwise = verdict.mirrorings.empty() ||
                      (!is_near(now, after, before, offsets, crossing) && !borderline);
  if (!verdict.mirrorings.empty()) verdict.mirrorings.back().after = after;
  return verdict;
}

// Adds reflections to the books, particle by particle.
class Bookkeeper {
 public:
  Bookkeeper(const Problem& problem, const State& before, WallBooks& books)
      : problem_(problem), potential_of_(problem.law), state_(before), books_(books) {
    CompensatedSum x, y, px, py;
    for (std::size_t i = 0; i < before.size(); ++i) {
      x.add(before.x[i]);
      y.add(before.y[i]);
      px.add(before.vx[i]);
      py.add(before.vy[i]);
    }
    n_ = static_cast<double>(before.size());
    centre_ = {x.value() / n_, y.value() / n_};
    momentum_ = {px.value(), py.value()};
  }

  void add(std::size_t i, const Mirroring& mirroring) {
    WallBook& book = books_.walls[mirroring.wall];
    const Particle from = particle_of(state_, i);
    const Particle& to = mirroring.after;
    const double bond = bond_energy(i);
    state_.x[i] = to.x;
    state_.y[i] = to.y;
    state_.vx[i] = to.vx;
    state_.vy[i] = to.vy;
    ++book.reflections;
    book.bond.add(bond_energy(i) - bond);
    book.kinetic.add(0.5 * (to.vx * to.vx + to.vy * to.vy) -
                     0.5 * (from.vx * from.vx + from.vy * from.vy));
    book.gravity.add(-problem_.gravity.x * (to.x - from.x) - problem_.gravity.y * (to.y - from.y));
    add_momentum(book, from, to);
  }

 private:
  // Of all bonds of particle i.
  [[nodiscard]] double bond_energy(std::size_t i) const {
    CompensatedSum energy;
    problem_.bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
      const double dx = state_.x[i] - state_.x[j], dy = state_.y[i] - state_.y[j];
      energy.add(potential_of_(problem_.classes[c], dx * dx + dy * dy));
    });
    return energy.value();
  }

  // The velocity's change, and its moment. Mirrored by d = to - from, a particle also shifts the
  // centre of mass by d/n; about the new centre the angular momentum is
  // L + (r x v) after - (r x v) before - d/n x P, r from the old centre, P after.
  void add_momentum(WallBook& book, const Particle& from, const Particle& to) {
    book.impulse_x.add(to.vx - from.vx);
    book.impulse_y.add(to.vy - from.vy);
    momentum_.x += to.vx - from.vx;
    momentum_.y += to.vy - from.vy;
    const Vec2 a{from.x - centre_.x, from.y - centre_.y}, b{to.x - centre_.x, to.y - centre_.y};
    const Vec2 shift{(to.x - from.x) / n_, (to.y - from.y) / n_};
    for (const double term : {b.x * to.vy, -b.y * to.vx, -a.x * from.vy, a.y * from.vx,
                              -shift.x * momentum_.y, shift.y * momentum_.x}) {
      book.torque.add(term);
      books_.torque_rounding.add(term, 3.0);
    }
    books_.momentum_rounding.add(std::abs(to.vx - from.vx) + std::abs(to.vy - from.vy));
    centre_.x += shift.x;
    centre_.y += shift.y;
  }

  const Problem& problem_;
  PotentialOf potential_of_;  // as measure() takes it, to the bit
  State state_;               // with the particles booked so far mirrored
  WallBooks& books_;
  double n_ = 0.0;
  Vec2 centre_, momentum_;
};

Problem without_walls(Problem problem) {
  problem.walls.clear();
  return problem;
}

double energy_of(const Problem& problem, const State& state, RoundingSize& rounding) {
  const Sample sample = measure(problem, state);
  // Each part of a total is rounded once, and so are the two sums of them. The terms of the parts
  // that a reflection leaves alone have the same bits before and after.
  rounding.add(std::abs(sample.kinetic) + std::abs(sample.bond) + std::abs(sample.gravity), 3.0);
  return sample.total();
}

}  // namespace

// The kernel, made for one stage, with walls and without.
struct BookingStepper::StageKernels {
  StageKernels(const Problem& problem, Stage only, const Make& make) : stage{only} {
    method = *problem.method;
    method.stages = stage;
    method.first_same_as_last = false;
    Problem one_stage = problem;
    one_stage.method = &method;
    with_walls = make(one_stage);
    without = make(without_walls(one_stage));
  }
  StageKernels(const StageKernels&) = delete;
  StageKernels& operator=(const StageKernels&) = delete;

  std::array<Stage, 1> stage;
  Method method;
  std::unique_ptr<Stepper> with_walls, without;
};

BookingStepper::BookingStepper(Problem problem, Make make)
    : problem_(std::move(problem)),
      make_(std::move(make)),
      with_walls_(make_(problem_)),
      without_walls_(make_(without_walls(problem_))) {
  const StageSequence sequence = stage_sequence(*problem_.method);
  for (const Stage& stage : sequence.fresh) add_stage(stage, fresh_);
  for (const Stage& stage : sequence.joined) add_stage(stage, joined_);
  open_books();
  book_unfinished();
}

BookingStepper::~BookingStepper() = default;

void BookingStepper::add_stage(Stage stage, std::vector<std::size_t>& sequence) {
  std::size_t at = 0;
  while (at < stages_.size() && !(stages_[at]->stage[0].kick == stage.kick &&
                                  stages_[at]->stage[0].drift == stage.drift)) {
    ++at;
  }
  if (at == stages_.size()) {
    stages_.push_back(std::make_unique<StageKernels>(problem_, stage, make_));
  }
  sequence.push_back(at);
}

void BookingStepper::open_books() {
  done_ = {};
  done_.walls.resize(problem_.walls.size());
  done_.energy = energy_of(problem_, with_walls_->save().state, done_.energy_rounding);
}

// The state as it is read out has its step finished on a copy, which may mirror, too.
void BookingStepper::book_unfinished() {
  books_ = done_;
  const Snapshot now = with_walls_->save();
  if (!now.stage_held || problem_.method->stages.back().drift == 0.0) return;
  without_walls_->restore(now);
  const State before = without_walls_->state(), after = with_walls_->state();
  if (same_bits(before, after)) return;
  book(problem_.method->stages.back().drift * problem_.step, before, after, books_);
  books_.unfinished = true;
}

void BookingStepper::advance(std::int64_t steps) {
  while (steps > 0) {
    const std::int64_t block = std::min(block_, steps);
    const Snapshot start = with_walls_->save();
    with_walls_->advance(block);
    without_walls_->restore(start);
    without_walls_->advance(block);
    if (same_bits(with_walls_->save().state, without_walls_->save().state)) {
      block_ = std::min(2 * block_, longest_block);
      look_behind_walls();
    } else if (block > 1) {
      with_walls_->restore(start);
      block_ = std::max<std::int64_t>(1, block / 4);
      continue;
    } else {
      block_ = 1;
      step_by_stages(start);
    }
    steps -= block;
  }
  book_unfinished();
}

void BookingStepper::fault(WallBooks& books) const {
  if (books.first_fault < 0) books.first_fault = step();
}

// After steps that mirrored nothing, nothing may stand behind a wall.
void BookingStepper::look_behind_walls() {
  const State now = with_walls_->save().state;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Particle p = particle_of(now, i);
    for (const Wall& wall : problem_.walls) {
      if (wall_distance(wall, p.x, p.y) >= -distance_rounding(wall, p)) continue;
      ++done_.missed;
      fault(done_);
    }
  }
}

// with_walls_ has taken the step; it is taken once more to see what happened in it.
void BookingStepper::step_by_stages(const Snapshot& start) {
  Snapshot now{start.state, false, 0};
  for (const std::size_t at : start.stage_held ? joined_ : fresh_) {
    StageKernels& kernels = *stages_[at];
    for (Stepper* stepper : {kernels.without.get(), kernels.with_walls.get()}) {
      stepper->restore(now);
      stepper->advance(1);
    }
    const State before = kernels.without->save().state;
    now = kernels.with_walls->save();
    now.stage_held = false;
    now.step = 0;
    const double drift = kernels.stage[0].drift * problem_.step;
    if (!same_bits(before, now.state)) book(drift, before, now.state, done_);
  }
  // The stages' bits are those of the step (a test holds that), or these are not this run's books.
  if (!same_bits(now.state, with_walls_->save().state)) {
    ++done_.otherwise;
    fault(done_);
  }
}

void BookingStepper::book(double drift, const State& before, const State& after,
                          WallBooks& books) const {
  const double energy = energy_of(problem_, before, books.energy_rounding);
  books.integrator.add(energy - books.energy);
  Bookkeeper keeper(problem_, before, books);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Particle from = particle_of(before, i), to = particle_of(after, i);
    if (same_bits(from, to) &&
        std::all_of(problem_.walls.begin(), problem_.walls.end(),
                    [&](const Wall& wall) { return wall_distance(wall, from.x, from.y) > 0.0; })) {
      continue;
    }
    const Verdict verdict = judge(problem_.walls, drift, from, to);
    for (const Mirroring& mirroring : verdict.mirrorings) keeper.add(i, mirroring);
    books.missed += verdict.missed ? 1 : 0;
    books.otherwise += verdict.otherwise ? 1 : 0;
    if (verdict.missed || verdict.otherwise) fault(books);
  }
  books.energy = energy_of(problem_, after, books.energy_rounding);
}

State BookingStepper::state() const { return with_walls_->state(); }

Snapshot BookingStepper::save() const {
  Snapshot snapshot = with_walls_->save();
  WordWriter words([&snapshot](std::span<const std::uint64_t> some) {
    snapshot.own.insert(snapshot.own.end(), some.begin(), some.end());
  });
  words(done_, block_);
  words.finish();
  return snapshot;
}

void BookingStepper::restore(const Snapshot& snapshot) {
  with_walls_->restore(snapshot);
  try {
    WordReader words(snapshot.own);
    words(done_, block_);
    words.finish();
  } catch (const WordsError&) {  // another kernel's
    open_books();
  }
  book_unfinished();
}

std::int64_t BookingStepper::step() const { return with_walls_->step(); }

}  // namespace bounce
