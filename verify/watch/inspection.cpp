#include "verify/watch/inspection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/model/powers.hpp"

namespace bounce {
namespace {

// Roundings of a bond's force, from the differences of the coordinates to the product with them:
// what csr and strict may differ by between its two ends.
constexpr double force_roundings = 8.0;
// Roundings of one bond's potential, on the sizes of its two terms.
constexpr double potential_roundings = 6.0;

// Roundings of a mirrored coordinate: distance, twice it, product and difference.
constexpr double mirror_roundings = 16.0;

// What acts on one particle, without the time step.
struct Load {
  Vec2 net;                  // force of bonds and gravity
  Vec2 sum;                  // of the sizes of the bonds' forces
  Vec2 parts, parts_square;  // of the sizes of their attraction and repulsion, and of the squares
  double stiffness = 0.0;
  double neighbours = 0.0;
};

// Sums over the bonds of one state.
struct BondSums {
  std::vector<Load> loads;
  double stiffness = 0.0;  // v.V''v
  double elastic = 0.0;    // less the bond energy at rest
  RoundingSize energy;
};

void load_end(Load& load, double sign, double f, double size, double stiffness, double dx,
              double dy) {
  load.net.x += sign * f * dx;
  load.net.y += sign * f * dy;
  load.sum.x += std::abs(f * dx);
  load.sum.y += std::abs(f * dy);
  load.parts.x += size * std::abs(dx);
  load.parts.y += size * std::abs(dy);
  load.parts_square.x += size * dx * size * dx;
  load.parts_square.y += size * dy * size * dy;
  load.stiffness += stiffness;
  load.neighbours += 1.0;
}

class BondLoader {
 public:
  BondLoader(const Model& model, const State& state)
      : model_(model), s_(state), attraction_(model.law.p + 1.0), repulsion_(model.law.q + 1.0) {}

  void add(std::size_t i, std::size_t j, const BondClass& bond, BondSums& sums) const {
    const double dx = s_.x[i] - s_.x[j], dy = s_.y[i] - s_.y[j];
    const double wx = s_.vx[i] - s_.vx[j], wy = s_.vy[i] - s_.vy[j];
    const double r2 = dx * dx + dy * dy;
    const double u = 1.0 / r2;
    const double attraction = bond.attraction * attraction_(u);                  // G/R^(p+1)
    const double repulsion = bond.repulsion * repulsion_(u);                     // H/R^(q+1)
    const double f = repulsion - attraction;                                     // F/R = -V'/R
    const double second = model_.law.q * repulsion - model_.law.p * attraction;  // V''
    const double along = (wx * dx + wy * dy) * (wx * dx + wy * dy) * u;
    sums.stiffness += second * along - f * (wx * wx + wy * wy - along);
    const double size = repulsion + attraction;
    const double stiffest = std::max(std::abs(second), std::abs(f));
    load_end(sums.loads[i], 1.0, f, size, stiffest, dx, dy);
    load_end(sums.loads[j], -1.0, f, size, stiffest, dx, dy);
    sums.energy.add(size * r2, potential_roundings);  // V is of the size of F R
  }

 private:
  const Model& model_;
  const State& s_;
  PowerOf attraction_, repulsion_;
};

BondSums load_bonds(const Model& model, const State& s) {
  BondSums sums;
  sums.loads.resize(s.size());
  const BondLoader loader(model, s);
  double rest = 0.0;
  std::vector<double> rest_energy;
  for (const BondClass& bond : model.classes) {
    rest_energy.push_back(potential(model.law, bond, bond.rest * bond.rest));
  }
  model.bonds.for_each_bond([&](std::size_t i, std::size_t j, std::size_t c) {
    rest += rest_energy[c];
    loader.add(i, j, model.classes[c], sums);
  });
  for (Load& load : sums.loads) {
    load.net.x += model.gravity.x;
    load.net.y += model.gravity.y;
  }
  sums.elastic = -rest;
  return sums;
}

double square(double value) { return value * value; }

// Roundings of one velocity component in a stage of that kick: additions whose partial sums are no
// greater than all sizes together, and the forces' own.
RoundingSize of_velocity(double speed, double kick, double gravity, double sum, double parts,
                         double parts_square, double neighbours) {
  RoundingSize rounding;
  rounding.add(std::abs(speed) + kick * (std::abs(gravity) + sum), neighbours + 2.0);
  rounding.worst += force_roundings * unit_roundoff * kick * parts;
  rounding.variance += force_roundings / 3.0 * square(unit_roundoff * kick) * parts_square;
  return rounding;
}

// Adds `error` of a number to a balance in which that number counts `lever` times.
void carry(RoundingSize& balance, const RoundingSize& error, double lever) {
  balance.worst += error.worst * std::abs(lever);
  balance.variance += error.variance * square(lever);
}

void add_stage(const Model& model, const State& s, const Sample& sample, double kick,
               const std::vector<Load>& loads, StepRounding& step) {
  const auto n = static_cast<double>(s.size());
  const Vec2 velocity{sample.momentum.x / n, sample.momentum.y / n};
  RoundingSize momentum_x, momentum_y, angular, energy;  // in registers
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Load& load = loads[i];
    const RoundingSize vx = of_velocity(s.vx[i], kick, model.gravity.x, load.sum.x, load.parts.x,
                                        load.parts_square.x, load.neighbours);
    const RoundingSize vy = of_velocity(s.vy[i], kick, model.gravity.y, load.sum.y, load.parts.y,
                                        load.parts_square.y, load.neighbours);
    RoundingSize x, y;
    x.add(s.x[i]);
    y.add(s.y[i]);
    carry(angular, vx, s.y[i] - sample.centre.y);
    carry(angular, vy, s.x[i] - sample.centre.x);
    carry(angular, x, s.vy[i] - velocity.y);
    carry(angular, y, s.vx[i] - velocity.x);
    carry(energy, vx, s.vx[i]);
    carry(energy, vy, s.vy[i]);
    carry(energy, x, load.net.x);
    carry(energy, y, load.net.y);
    momentum_x.add(vx);
    momentum_y.add(vy);
  }
  step.momentum_x.add(momentum_x);
  step.momentum_y.add(momentum_y);
  step.angular.add(angular);
  step.energy.add(energy);
}

void measure_rounding(const Model& model, const State& s, const Sample& sample, Inspection& here) {
  RoundingSize angular, energy;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double rx = std::abs(s.x[i] - sample.centre.x), ry = std::abs(s.y[i] - sample.centre.y);
    angular.add(rx * s.vy[i], 2.0);
    angular.add(ry * s.vx[i], 2.0);
    energy.add(0.5 * (s.vx[i] * s.vx[i] + s.vy[i] * s.vy[i]), 3.0);
    energy.add(model.gravity.x * s.x[i]);
    energy.add(model.gravity.y * s.y[i]);
  }
  here.angular.add(angular);
  here.energy.add(energy);
  // The centre of mass is rounded, too, and so are the sums and differences of them.
  here.angular.add(sample.centre.x * sample.momentum.y, 2.0);
  here.angular.add(sample.centre.y * sample.momentum.x, 2.0);
  here.angular.add(sample.angular_momentum);
  here.energy.add(std::abs(sample.kinetic) + std::abs(sample.bond) + std::abs(sample.gravity), 3.0);
}

void measure_reach(const Model& model, const State& s, Inspection& here) {
  double fastest = 0.0;  // squared
  for (std::size_t i = 0; i < s.size(); ++i) {
    fastest = std::max(fastest, s.vx[i] * s.vx[i] + s.vy[i] * s.vy[i]);
  }
  here.fastest = std::sqrt(fastest);
  here.nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (const Wall& wall : model.walls) {
      const double distance = wall_distance(wall, s.x[i], s.y[i]);
      const double size = std::abs(s.x[i]) + std::abs(s.y[i]) + std::abs(wall.offset);
      here.nearest = std::min(here.nearest, distance);
      here.behind = std::max(here.behind, -distance - mirror_roundings * unit_roundoff * size);
    }
  }
}

}  // namespace

ModifiedEnergy modified_energy(const Method& method) {
  // The logarithm of the step so far: a A + b B + e [A,B] + f [A,[A,B]] + h [B,[B,A]], A the drift,
  // B the kick, what is done first standing left. exp(.) of each further part is multiplied on the
  // right. As Lie derivatives [A,B], [A,[A,B]], [B,[B,A]] belong to v.grad V, v.V''v, |grad V|^2.
  double a = 0.0, b = 0.0;
  ModifiedEnergy z;
  for (const Stage& stage : method.stages) {
    const double k = stage.kick;
    z.stiffness += a * a * k / 12.0;
    z.force += 0.5 * k * z.first - a * b * k / 12.0 + a * k * k / 12.0;
    z.first += 0.5 * a * k;
    b += k;
    const double c = stage.drift;
    z.stiffness += -0.5 * c * z.first - a * b * c / 12.0 + c * c * b / 12.0;
    z.force += c * b * b / 12.0;
    z.first -= 0.5 * c * b;
    a += c;
  }
  return z;
}

double left_out(const Model& model, const Inspection& here) {
  const double angle = here.frequency * model.step;
  const int order = angle < 1.0 ? std::max(3, model.method->order) : 3;
  return std::pow(angle, order) * std::abs(here.internal);
}

Inspection inspect(const Model& model, const State& state, const Sample& sample) {
  const BondSums sums = load_bonds(model, state);
  Inspection here;
  double power = 0.0;  // of bonds and gravity, -v.grad V
  double force = 0.0;  // |grad V|^2
  double row = 0.0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Load& load = sums.loads[i];
    power += load.net.x * state.vx[i] + load.net.y * state.vy[i];
    force += load.net.x * load.net.x + load.net.y * load.net.y;
    row = std::max(row, load.stiffness);
  }
  const ModifiedEnergy z = modified_energy(*model.method);
  const double dt = model.step;
  here.swing = dt * (dt * (z.stiffness * sums.stiffness + z.force * force) - z.first * power);
  const auto n = static_cast<double>(state.size());
  here.internal = sample.kinetic -
                  0.5 * (square(sample.momentum.x) + square(sample.momentum.y)) / n + sample.bond +
                  sums.elastic;
  here.frequency = std::sqrt(2.0 * row);
  measure_reach(model, state, here);
  measure_rounding(model, state, sample, here);
  here.energy.add(sums.energy);
  for (const Stage& stage : model.method->stages) {
    add_stage(model, state, sample, std::abs(stage.kick) * dt, sums.loads, here.step);
  }
  return here;
}

}  // namespace bounce
