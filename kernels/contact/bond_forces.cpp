#include "kernels/contact/bond_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bounce {
namespace {

template <class Real>
Real power(Real u, Real exponent) {
  if (exponent == 2) return u * u;
  if (exponent == 3) return u * u * u;
  return std::pow(u, exponent);
}

// Two loops that vectors may take: within each, what is written stands nowhere else. (The near and
// the far ends of a run are of one array, and may overlap.)
template <class Real, class Force>
void act_near(std::size_t count, const Real* xi, const Real* yi, const Real* xj, const Real* yj,
              const Force& force, Real* __restrict fx, Real* __restrict fy, Real* __restrict axi,
              Real* __restrict ayi) {
  for (std::size_t k = 0; k < count; ++k) {
    const Real dx = xi[k] - xj[k], dy = yi[k] - yj[k];
    const Real f = force(1 / (dx * dx + dy * dy));
    fx[k] = f * dx;
    fy[k] = f * dy;
    axi[k] += fx[k];
    ayi[k] += fy[k];
  }
}
template <class Real>
void act_far(std::size_t count, const Real* __restrict fx, const Real* __restrict fy,
             Real* __restrict axj, Real* __restrict ayj) {
  for (std::size_t k = 0; k < count; ++k) {
    axj[k] -= fx[k];
    ayj[k] -= fy[k];
  }
}

}  // namespace

template <class Real>
BondForces<Real>::BondForces(const Problem& problem)
    : problem_(&problem),
      is_papers_(problem.law.p == 3.0 && problem.law.q == 5.0),
      attraction_power_(static_cast<Real>(0.5 * (problem.law.p + 1.0))),
      repulsion_power_(static_cast<Real>(0.5 * (problem.law.q + 1.0))) {
  find_runs();
}

template <class Real>
auto BondForces<Real>::bond(std::size_t bond_class) const -> Bond {
  const BondClass& of_class = problem_->classes[bond_class];
  return {static_cast<Real>(of_class.attraction), static_cast<Real>(of_class.repulsion)};
}

// Bonds are sorted by class, by how far apart their ends are numbered, and by the lower one.
template <class Real>
void BondForces<Real>::find_runs() {
  using Key = std::array<std::size_t, 3>;
  std::vector<Key> bonds;
  for (std::size_t i = 0; i < particles(); ++i) {
    problem_->bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
      if (j > i) bonds.push_back({c, j - i, i});
    });
  }
  std::sort(bonds.begin(), bonds.end());
  for (std::size_t k = 0; k < bonds.size(); ++k) {
    const auto [c, apart, i] = bonds[k];
    if (k > 0 && bonds[k - 1] == Key{c, apart, i - 1}) {
      ++runs_.back().length;
    } else {
      runs_.push_back({i, i + apart, 1, bond(c)});
    }
  }
}

template <class Real>
void BondForces<Real>::operator()(const Real* x, const Real* y, Real* ax, Real* ay) const {
  const std::size_t n = particles();
  std::fill(ax, ax + n, static_cast<Real>(problem_->gravity.x));
  std::fill(ay, ay + n, static_cast<Real>(problem_->gravity.y));
  if (is_papers_) {
    add_bonds(x, y, ax, ay, [](const Bond& bond, Real u) {
      return u * u * (bond.repulsion * u - bond.attraction);
    });
  } else {
    add_bonds(x, y, ax, ay,
              [this](const Bond& bond, Real u) { return over_distance(bond, u).force; });
  }
}

template <class Real>
template <class Law>
void BondForces<Real>::add_bonds(const Real* x, const Real* y, Real* ax, Real* ay,
                                 const Law& law) const {
  constexpr std::size_t block = 256;
  std::array<Real, block> fx, fy;
  for (const Run& run : runs_) {
    const Bond bond = run.bond;
    for (std::size_t done = 0; done < run.length; done += block) {
      const std::size_t count = std::min(block, run.length - done);
      const std::size_t i = run.first + done, j = run.other + done;
      act_near(
          count, x + i, y + i, x + j, y + j, [&](Real u) { return law(bond, u); }, fx.data(),
          fy.data(), ax + i, ay + i);
      act_far(count, fx.data(), fy.data(), ax + j, ay + j);
    }
  }
}

template <class Real>
Pull<Real> BondForces<Real>::pull(std::size_t i, Vec2 n, const StateParts<const Real>& s) const {
  const auto nx = static_cast<Real>(n.x);
  const auto ny = static_cast<Real>(n.y);
  Pull<Real> pull{
      nx * static_cast<Real>(problem_->gravity.x) + ny * static_cast<Real>(problem_->gravity.y),
      Real(0)};
  problem_->bonds.visit_row(i, [&](std::size_t j, std::size_t c) {
    const Real dx = s.x[i] - s.x[j], dy = s.y[i] - s.y[j];
    const Real wx = s.vx[i] - s.vx[j], wy = s.vy[i] - s.vy[j];
    const Force force = over_distance(bond(c), 1 / (dx * dx + dy * dy));
    const Real along = nx * dx + ny * dy;
    pull.acceleration += force.force * along;
    pull.jerk += force.force * (nx * wx + ny * wy) + 2 * force.slope * (dx * wx + dy * wy) * along;
  });
  return pull;
}

template <class Real>
auto BondForces<Real>::over_distance(const Bond& bond, Real u) const -> Force {
  const Real attraction = bond.attraction * power(u, attraction_power_);
  const Real repulsion = bond.repulsion * power(u, repulsion_power_);
  return {repulsion - attraction,
          u * (attraction_power_ * attraction - repulsion_power_ * repulsion)};
}

template class BondForces<double>;
template class BondForces<long double>;

}  // namespace bounce
