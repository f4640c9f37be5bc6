#include "verify/accuracy/conservative.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "kernels/model/wall_rule.hpp"

namespace bounce {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Vector2d;

// A force between two places of a bond, and its change with the second one.
struct MeanForce {
  double factor;  // F = factor (d + d')
  double slope;   // of the factor, by s'
};
MeanForce mean_force(double attraction, double repulsion, double s, double s_new) {
  const double u = 1.0 / s, w = 1.0 / s_new;
  return {0.5 * u * w * (0.5 * repulsion * (u + w) - attraction),
          -0.5 * u * w * w * (repulsion * (0.5 * u + w) - attraction)};
}

// Corrections that shrink by less than this a round call for a new matrix.
constexpr double good_shrinking = 0.1;
// A correction of the way of this part of a coordinate's size is rounding: some units in the last
// place of x + w. One round more is taken then, which costs little and leaves rounding alone.
constexpr double settled = 4e-15;
// Newton doubles the digits in each round: from one digit on, 5 do. A round with an old matrix
// gains at least one, so 16 do; with as many again, what has not settled never will.
constexpr int most_rounds = 40;

}  // namespace

std::string conservative_refusal(const Problem& problem) {
  if (problem.law.p == 3.0 && problem.law.q == 5.0) return {};
  return "the conservative method is for exponents p = 3, q = 5";
}

ConservativeStepper::ConservativeStepper(const Problem& problem)
    : problem_(&problem), state_(problem.initial) {
  if (const std::string why = conservative_refusal(problem); !why.empty()) {
    throw std::invalid_argument(why);
  }
  for (std::size_t i = 0; i < state_.size(); ++i) {
    problem.bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
      if (j < i) return;
      bonds_.push_back({i, j, problem.classes[c].attraction, problem.classes[c].repulsion});
    });
  }
  const auto size = static_cast<Index>(2 * state_.size());
  for (Eigen::VectorXd* const each : {&x_, &v_, &way_, &acceleration_}) each->setZero(size);
  matrix_.resize(size, size);
}

void ConservativeStepper::restore(const Snapshot& snapshot) {
  if (snapshot.stage_held) {
    throw std::invalid_argument("the conservative method holds no stage over");
  }
  state_ = snapshot.state;
  step_ = snapshot.step;
  has_factors_ = false;  // so that what follows does not depend on what was before
}

void ConservativeStepper::advance(std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k) take_step();
}

void ConservativeStepper::take_step() {
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const auto row = static_cast<Index>(2 * i);
    x_.segment<2>(row) << state_.x[i], state_.y[i];
    v_.segment<2>(row) << state_.vx[i], state_.vy[i];
  }
  if (!solve()) way_.setConstant(std::numeric_limits<double>::quiet_NaN());
  // Not 2 w / dt - v: the sum of the forces is the momentum's change to the last roundings.
  v_ += problem_->step * acceleration_;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const auto row = static_cast<Index>(2 * i);
    state_.x[i] += way_[row];
    state_.y[i] += way_[row + 1];
    state_.vx[i] = v_[row];
    state_.vy[i] = v_[row + 1];
  }
  meet_walls();
  ++step_;
}

// The way and the mean acceleration along it; false if Newton does not get there.
bool ConservativeStepper::solve() {
  const double dt = problem_->step;
  const double rounding = settled * (x_.lpNorm<Eigen::Infinity>() + 1.0);
  way_ = dt * v_;
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    accelerate();
    if (!has_factors_) factorise();
    if (!has_factors_) return false;
    const Eigen::VectorXd miss = dt * v_ + 0.5 * dt * dt * acceleration_ - way_;
    const Eigen::VectorXd correction = solver_.solve(miss);
    const double size = correction.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size)) break;
    way_ += correction;
    if (last <= rounding) {  // one more than needed
      accelerate();
      return true;
    }
    if (!(size <= rounding || size <= good_shrinking * last)) has_factors_ = false;
    last = size;
  }
  has_factors_ = false;
  return false;
}

void ConservativeStepper::accelerate() {
  ++evaluations_;
  for (Index i = 0; i < acceleration_.size(); i += 2) {
    acceleration_.segment<2>(i) << problem_->gravity.x, problem_->gravity.y;
  }
  for (const Bond& bond : bonds_) {
    const auto i = static_cast<Index>(2 * bond.i), j = static_cast<Index>(2 * bond.j);
    const Vector2d d = x_.segment<2>(i) - x_.segment<2>(j);
    const Vector2d e = d + (way_.segment<2>(i) - way_.segment<2>(j));
    const Vector2d force =
        mean_force(bond.attraction, bond.repulsion, d.squaredNorm(), e.squaredNorm()).factor *
        (d + e);
    acceleration_.segment<2>(i) += force;
    acceleration_.segment<2>(j) -= force;
  }
}

// 1 - dt^2/2 da/dw at the way.
void ConservativeStepper::factorise() {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(16 * bonds_.size() + static_cast<std::size_t>(x_.size()));
  for (Index i = 0; i < x_.size(); ++i) entries.emplace_back(i, i, 1.0);
  const double share = 0.5 * problem_->step * problem_->step;
  for (const Bond& bond : bonds_) {
    const auto i = static_cast<Index>(2 * bond.i), j = static_cast<Index>(2 * bond.j);
    const Vector2d d = x_.segment<2>(i) - x_.segment<2>(j);
    const Vector2d e = d + (way_.segment<2>(i) - way_.segment<2>(j));
    const MeanForce force =
        mean_force(bond.attraction, bond.repulsion, d.squaredNorm(), e.squaredNorm());
    const Matrix2d block =
        share * (force.factor * Matrix2d::Identity() + 2.0 * force.slope * (d + e) * e.transpose());
    for (Index r = 0; r < 2; ++r) {
      for (Index c = 0; c < 2; ++c) {
        entries.emplace_back(i + r, i + c, -block(r, c));
        entries.emplace_back(j + r, j + c, -block(r, c));
        entries.emplace_back(i + r, j + c, block(r, c));
        entries.emplace_back(j + r, i + c, block(r, c));
      }
    }
  }
  matrix_.setFromTriplets(entries.begin(), entries.end());
  if (!has_pattern_) solver_.analyzePattern(matrix_);
  has_pattern_ = true;
  solver_.factorize(matrix_);
  ++factorisations_;
  has_factors_ = solver_.info() == Eigen::Success;
}

void ConservativeStepper::meet_walls() {
  for (std::size_t i = 0; i < state_.size(); ++i) {
    for (const Wall& wall : problem_->walls) {
      if (wall_distance(wall, state_.x[i], state_.y[i]) > 0.0) continue;
      const Motion after = after_wall(wall, problem_->step,
                                      {{state_.x[i], state_.y[i]}, {state_.vx[i], state_.vy[i]}});
      state_.x[i] = after.position.x;
      state_.y[i] = after.position.y;
      state_.vx[i] = after.velocity.x;
      state_.vy[i] = after.velocity.y;
    }
  }
}

}  // namespace bounce
