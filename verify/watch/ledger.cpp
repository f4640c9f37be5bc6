#include "verify/watch/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace bounce {
namespace {

// The greater of two estimates of a step, taken at both ends of an interval, for all its steps.
RoundingSize over_steps(const RoundingSize& a, const RoundingSize& b, double steps) {
  RoundingSize sum;
  sum.worst = steps * std::max(a.worst, b.worst);
  sum.variance = steps * std::max(a.variance, b.variance);
  return sum;
}

// NaN counts as not within.
bool within(double value, double allowed) { return std::abs(value) <= allowed; }

}  // namespace

bool LedgerReport::closes() const {
  return std::all_of(lines.begin(), lines.end(), [](const LedgerLine& l) { return l.closes(); });
}

Ledger::Ledger(const Model& model, bool full)
    : model_(model),
      full_(full),
      held_drift_(model.method->first_same_as_last
                      ? std::abs(model.method->stages.back().drift) * model.step
                      : 0.0),
      free_energy_{.name = "energy without contact", .unit = "erg"},
      behind_{.name = "walls", .unit = "cm"} {}

void Ledger::add(std::int64_t step, const State& state, const Sample& sample,
                 const WallBooks* books) {
  if (before_ && step <= before_->step) {
    throw std::invalid_argument("samples of a ledger are not in the order of steps");
  }
  if (full_ && books == nullptr) throw std::invalid_argument("the full ledger needs books");
  Look now{step, sample, inspect(model_, state, sample), full_ ? *books : WallBooks{}};
  greatest_swing_ = std::max(greatest_swing_, std::abs(now.inspection.swing));
  interval_ = {};
  if (!start_) {
    start_ = now;
    begin_stretch(now);
  } else {
    measure_walls(now);
    close_momentum(now);
    close_energy(now);
    check_walls(now);
  }
  before_ = std::move(now);
}

double Ledger::steps_to(const Look& now) const {
  return static_cast<double>(now.step - before_->step);
}

// Change of momentum that gravity does not explain.
Vec2 Ledger::beyond_gravity(const Look& now) const {
  const auto n = static_cast<double>(model_.bonds.particles());
  const double mass_time = n * steps_to(now) * model_.step;
  const Vec2 &a = before_->sample.momentum, &b = now.sample.momentum;
  return {b.x - a.x - mass_time * model_.gravity.x, b.y - a.y - mass_time * model_.gravity.y};
}

// Of an interval's steps, of gravity's kick (multiplied out once, so with one sign), of the two
// measured momenta, and of the difference itself.
RoundingSize Ledger::rounding_x(const Look& now) const {
  RoundingSize sum = over_steps(before_->inspection.step.momentum_x, now.inspection.step.momentum_x,
                                steps_to(now));
  const double sizes = std::abs(before_->sample.momentum.x) + std::abs(now.sample.momentum.x);
  sum.add(sizes + std::abs(beyond_gravity(now).x), 4.0);
  return sum;
}

RoundingSize Ledger::rounding_y(const Look& now) const {
  RoundingSize sum = over_steps(before_->inspection.step.momentum_y, now.inspection.step.momentum_y,
                                steps_to(now));
  const double sizes = std::abs(before_->sample.momentum.y) + std::abs(now.sample.momentum.y);
  sum.add(sizes + std::abs(beyond_gravity(now).y), 4.0);
  return sum;
}

// What the walls did in the interval: booked, or what gravity does not explain.
void Ledger::measure_walls(const Look& now) {
  const Vec2 rest = beyond_gravity(now);
  if (full_) {
    const WallBooks &a = before_->books, &b = now.books;
    interval_.reflections = b.reflections() - a.reflections();
    interval_.contact = interval_.reflections > 0 || a.unfinished || b.unfinished;
    interval_.impulse = {b.impulse().x - a.impulse().x, b.impulse().y - a.impulse().y};
    interval_.torque = b.torque() - a.torque();
    for (std::size_t w = 0; w < b.walls.size(); ++w) {
      interval_.kinetic += b.walls[w].kinetic.value() - a.walls[w].kinetic.value();
      interval_.gravity += b.walls[w].gravity.value() - a.walls[w].gravity.value();
      interval_.bond += b.walls[w].bond.value() - a.walls[w].bond.value();
    }
    interval_.walls = b.energy_given() - a.energy_given();
  } else {
    const double time = steps_to(now) * model_.step;
    const double pull = std::hypot(model_.gravity.x, model_.gravity.y);
    // Twice as fast as any particle was at either end.
    const double reach =
        2.0 * std::max(before_->inspection.fastest, now.inspection.fastest) * time +
        pull * time * time;
    const double nearest = std::min(before_->inspection.nearest, now.inspection.nearest);
    const bool out_of_reach = nearest > reach;
    const bool pushed =
        !(within(rest.x, rounding_x(now).worst) && within(rest.y, rounding_y(now).worst));
    // A step finished on a copy may have mirrored a particle that the run mirrors elsewhere, or not
    // at all: the momentum need not show it.
    const bool copied = held_drift_ > 0.0 && nearest <= reach * held_drift_ / time;
    interval_.contact = (pushed && !out_of_reach) || copied;
    if (interval_.contact) {
      interval_.impulse = rest;
      interval_.torque = now.sample.angular_momentum - before_->sample.angular_momentum;
      interval_.walls = now.modified() - before_->modified();
    }
  }
  impulse_x_.add(interval_.impulse.x);
  impulse_y_.add(interval_.impulse.y);
  torque_.add(interval_.torque);
  walls_.add(interval_.walls);
  if (!interval_.contact) free_steps_.add(steps_to(now));
}

void Ledger::close(Balance& balance, double left_over, const RoundingSize& explained,
                   std::int64_t step) {
  balance.residual.add(left_over);
  balance.rounding.add(explained);
  const bool closes = within(left_over, explained.worst) &&
                      within(balance.residual.value(), balance.rounding.worst);
  if (!closes && balance.fault_step < 0) balance.fault_step = step;
}

void Ledger::close_momentum(const Look& now) {
  if (!full_ && interval_.contact) return;
  const Vec2 rest = beyond_gravity(now);
  RoundingSize x = rounding_x(now), y = rounding_y(now);
  RoundingSize angular =
      over_steps(before_->inspection.step.angular, now.inspection.step.angular, steps_to(now));
  angular.add(before_->inspection.angular);
  angular.add(now.inspection.angular);
  if (full_) {
    // Each reflection's, and of the sums that the interval is a difference of.
    const auto since = [](const RoundingSize& a, const RoundingSize& b, double sum,
                          RoundingSize& rounding) {
      rounding.worst += b.worst - a.worst;
      rounding.variance += b.variance - a.variance;
      rounding.add(sum, 4.0);
    };
    const WallBooks &a = before_->books, &b = now.books;
    since(a.momentum_rounding, b.momentum_rounding, b.impulse().x, x);
    since(a.momentum_rounding, b.momentum_rounding, b.impulse().y, y);
    since(a.torque_rounding, b.torque_rounding, b.torque(), angular);
  }
  interval_.momentum_residual = {rest.x - interval_.impulse.x, rest.y - interval_.impulse.y};
  interval_.angular_residual =
      now.sample.angular_momentum - before_->sample.angular_momentum - interval_.torque;
  close(momentum_x_, interval_.momentum_residual.x, x, now.step);
  close(momentum_y_, interval_.momentum_residual.y, y, now.step);
  close(angular_, interval_.angular_residual, angular, now.step);
}

void Ledger::begin_stretch(const Look& now) {
  stretch_ = {};
  stretch_.start = now.modified();
  stretch_.steps.add(now.inspection.energy);
}

void Ledger::close_energy(const Look& now) {
  interval_.swing = before_->inspection.swing - now.inspection.swing;
  interval_.drift =
      !full_ && interval_.contact ? 0.0 : now.modified() - before_->modified() - interval_.walls;
  if (interval_.contact) {
    begin_stretch(now);
  } else {
    check_stretch(now);
  }
  if (!full_) return;
  // Energy is booked twice, reflection by reflection and on the whole ball between them.
  const WallBooks& books = now.books;
  const double left_over =
      books.energy - start_->books.energy - books.energy_given() - books.integrator.value();
  if (!within(left_over, books.energy_rounding.worst) && booked_fault_ < 0) {
    booked_fault_ = now.step;
  }
}

// Without contact the modified energy keeps what it was at the start of the stretch, but for
// rounding and the terms left out of it.
void Ledger::check_stretch(const Look& now) {
  const Inspection& here = now.inspection;
  stretch_.steps.add(over_steps(before_->inspection.step.energy, here.step.energy, steps_to(now)));
  stretch_.left_out =
      std::max({stretch_.left_out, left_out(model_, before_->inspection), left_out(model_, here)});
  RoundingSize rounding = stretch_.steps;
  rounding.add(here.energy);
  const double residual = now.modified() - stretch_.start;
  const double allowed = rounding.worst + stretch_.left_out;
  const bool closes = within(residual, allowed);
  const bool nearer = free_energy_.allowed == 0.0 || std::abs(residual) * free_energy_.allowed >
                                                         std::abs(free_energy_.residual) * allowed;
  if (free_energy_.fault_step < 0 && (nearer || !closes)) {
    free_energy_.residual = residual;
    free_energy_.likely = rounding.likely();
    free_energy_.allowed = allowed;
  }
  if (!closes && free_energy_.fault_step < 0) free_energy_.fault_step = now.step;
}

// With one wall nothing may stand behind it after a step. Between several, a particle that the last
// one mirrored may for a step stand behind another.
void Ledger::check_walls(const Look& now) {
  const bool corner = model_.walls.size() > 1;
  const double allowed = corner ? 2.0 * now.inspection.fastest * model_.step : 0.0;
  const double depth = now.inspection.behind;
  if (behind_.fault_step < 0 && depth >= behind_.residual) {
    behind_.residual = depth;
    behind_.allowed = allowed;
  }
  const bool kept_to_the_rule = now.books.missed == 0 && now.books.otherwise == 0;
  if (!(within(depth, allowed) && kept_to_the_rule) && behind_.fault_step < 0) {
    behind_.fault_step = now.step;
  }
}

LedgerReport Ledger::report() const {
  LedgerReport report;
  report.full = full_;
  if (!before_) return report;
  report.change = before_->sample.total() - start_->sample.total();
  report.walls = walls_.value();
  report.swing = start_->inspection.swing - before_->inspection.swing;
  report.drift = before_->modified() - start_->modified() - report.walls;
  report.greatest_swing = greatest_swing_;
  const auto steps = static_cast<double>(before_->step - start_->step);
  report.free_share = steps > 0.0 ? free_steps_.value() / steps : 1.0;
  report.impulse = {impulse_x_.value(), impulse_y_.value()};
  report.torque = torque_.value();
  const auto line = [](const char* name, const char* unit, const Balance& balance) {
    return LedgerLine{name,
                      unit,
                      balance.residual.value(),
                      balance.rounding.likely(),
                      balance.rounding.worst,
                      balance.fault_step};
  };
  report.lines = {line("momentum x", "cm/s", momentum_x_), line("momentum y", "cm/s", momentum_y_),
                  line("angular momentum", "cm^2/s", angular_), free_energy_};
  if (full_) {
    const WallBooks& books = before_->books;
    report.lines.push_back(
        {"energy booked", "erg",
         books.energy - start_->books.energy - books.energy_given() - books.integrator.value(),
         books.energy_rounding.likely(), books.energy_rounding.worst, booked_fault_});
    report.books = books.walls;
    report.missed = books.missed;
    report.otherwise = books.otherwise;
  }
  report.lines.push_back(behind_);
  return report;
}

}  // namespace bounce
