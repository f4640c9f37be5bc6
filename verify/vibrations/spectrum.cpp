#include "verify/vibrations/spectrum.hpp"

#include <Spectra/MatOp/SparseGenMatProd.h>
#include <Spectra/SymEigsSolver.h>
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/model/powers.hpp"

namespace bounce {
namespace {

// Rows up to which the dense solver is as quick. Lanczos must not be used on these: where all
// vibrations have one frequency or two, as in a ring of four, Spectra 1.0 loses orthogonality and
// returns a number that is no eigenvalue.
constexpr Eigen::Index smallest_for_lanczos = 100;

// Position of particle i less that of its neighbour j, cm.
struct Separation {
  double dx, dy, r2;
  Separation(const State& s, std::size_t i, std::size_t j)
      : dx(s.x[i] - s.x[j]), dy(s.y[i] - s.y[j]), r2(dx * dx + dy * dy) {}
};

// Entries of the symmetric 2 x 2 matrix along e e^T + across (1 - e e^T).
struct Block {
  double xx = 0.0, xy = 0.0, yy = 0.0;
};
Block block_of(const Separation& d, const Stiffness& k) {
  const double more = (k.along - k.across) / d.r2;
  return {k.across + more * d.dx * d.dx, more * d.dx * d.dy, k.across + more * d.dy * d.dy};
}

void put(Hessian& hessian, std::size_t row, std::size_t column, const Block& block) {
  const auto r = static_cast<Eigen::Index>(2 * row);
  const auto c = static_cast<Eigen::Index>(2 * column);
  hessian.insert(r, c) = block.xx;
  hessian.insert(r, c + 1) = block.xy;
  hessian.insert(r + 1, c) = block.xy;
  hessian.insert(r + 1, c + 1) = block.yy;
}

// The larger stiffness k of each bond, 0 if both are negative.
struct Stiffnesses {
  std::vector<double> of_bond;  // in the order of Neighbours::for_each_bond
  std::vector<double> sum;      // over the bonds of each particle
  StiffnessBound stiffest;      // the bond with the largest k; lambda 0 as yet
};

// Nothing if a distance, a stiffness or a sum is not finite.
std::optional<Stiffnesses> stiffnesses(const Problem& problem, const State& state) {
  const Neighbours& bonds = problem.bonds;
  Stiffnesses all{{}, std::vector<double>(bonds.particles(), 0.0), {}};
  all.of_bond.reserve(bonds.bonds());
  double stiffest = -1.0;
  double its_r2 = 0.0;
  double its_rest = 1.0;
  double finite = 0.0;  // NaN where anything is not
  const StiffnessOf stiffness_of(problem.law);
  bonds.for_each_bond([&](std::size_t i, std::size_t j, std::size_t c) {
    const BondClass& bond = problem.classes[c];
    const double r2 = Separation(state, i, j).r2;
    const Stiffness both = stiffness_of(bond, r2);
    // A bond to infinity has no stiffness at all: its length must be looked at, too.
    finite += 0.0 * (r2 + both.along + both.across);
    const double k = std::max(std::max(both.along, both.across), 0.0);
    all.of_bond.push_back(k);
    all.sum[i] += k;
    all.sum[j] += k;
    if (!(k > stiffest)) return;
    stiffest = k;
    its_r2 = r2;
    its_rest = bond.rest;
    all.stiffest.first = static_cast<std::int64_t>(i);
    all.stiffest.second = static_cast<std::int64_t>(j);
  });
  for (const double sum : all.sum) finite += 0.0 * sum;
  if (std::isnan(finite)) return std::nullopt;
  all.stiffest.ratio = std::sqrt(its_r2) / its_rest;
  return all;
}

double dense_largest(const Hessian& hessian) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(hessian, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

// The largest |row sum| of absolute values; no eigenvalue is larger in size. A NaN stays.
double largest_row_sum(const Hessian& hessian) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(hessian.cols());
  return (hessian.cwiseAbs() * ones).maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace

Hessian bond_hessian(const Problem& problem, const State& state) {
  const BondList& bonds = problem.bonds;
  const std::size_t n = bonds.particles();
  Eigen::VectorXi room(static_cast<Eigen::Index>(2 * n));
  for (std::size_t i = 0; i < n; ++i) {
    const auto blocks = static_cast<int>(bonds.start[i + 1] - bonds.start[i]) + 1;
    room.segment<2>(static_cast<Eigen::Index>(2 * i)).setConstant(2 * blocks);
  }
  Hessian hessian(room.size(), room.size());
  hessian.reserve(room);
  for (std::size_t i = 0; i < n; ++i) {
    Block own;
    const auto end = static_cast<std::size_t>(bonds.start[i + 1]);
    for (auto e = static_cast<std::size_t>(bonds.start[i]); e < end; ++e) {
      const auto j = static_cast<std::size_t>(bonds.neighbour[e]);
      const Separation d(state, i, j);
      const BondClass& bond = problem.classes[bonds.bond_class[e]];
      const Block k = block_of(d, stiffness(problem.law, bond, d.r2));
      put(hessian, i, j, {-k.xx, -k.xy, -k.yy});
      own = {own.xx + k.xx, own.xy + k.xy, own.yy + k.yy};
    }
    put(hessian, i, i, own);
  }
  hessian.makeCompressed();
  return hessian;
}

std::optional<double> largest_eigenvalue(const Hessian& hessian, double tolerance) {
  const double scale = largest_row_sum(hessian);
  if (!std::isfinite(scale)) return std::nullopt;
  if (scale == 0.0) return 0.0;
  // Scaled, so that no threshold inside the solvers depends on units.
  const Hessian scaled = hessian / scale;
  if (scaled.rows() <= smallest_for_lanczos) return scale * dense_largest(scaled);
  constexpr Eigen::Index subspace = 20;    // 40 and 80 took as many products and more time
  constexpr Eigen::Index restarts = 2000;  // of some 10 products
  using Product = Spectra::SparseGenMatProd<double, Eigen::RowMajor>;
  Product product(scaled);
  Spectra::SymEigsSolver<Product> solver(product, 1, subspace);
  solver.init();  // a random vector, always the same one
  solver.compute(Spectra::SortRule::LargestAlge, restarts, tolerance);
  if (solver.info() != Spectra::CompInfo::Successful) return std::nullopt;
  const double largest = solver.eigenvalues()[0];
  const Eigen::VectorXd vector = solver.eigenvectors(1);
  const double residual = (scaled * vector - largest * vector).norm();
  // What the solver promises, looked at: ten times, as its own estimate and rounding may differ.
  if (!(residual <= 10.0 * tolerance * std::abs(largest))) return std::nullopt;
  return scale * largest;
}

// Why no eigenvalue of the Hessian H is larger. Let k(e) be the larger stiffness of bond e = (i,
// j), along or across, or 0 if both are negative. For any displacement u, with w(i) = |u(i)|,
//
//   u^T H u = sum over e of (u(i) - u(j))^T K(e) (u(i) - u(j)) <= sum of k(e) |u(i) - u(j)|^2
//          <= sum of k(e) (w(i) + w(j))^2 = w^T Q w,   Q(i, i) = d(i) = sum of i's k,  Q(i, j) = k,
//
// so lambda_max(H) <= lambda_max(Q). Q has no negative entry, and with weights p > 0 the matrix
// Q(i, j) p(j) / p(i) has the eigenvalues of Q, so none is above its largest row sum. With p = 1
// that is 2 max d(i); with p = d, d(i) + sum of k d(j) / d(i), which is never more.
std::optional<StiffnessBound> stiffness_bound(const Problem& problem, const State& state) {
  const std::optional<Stiffnesses> stiff = stiffnesses(problem, state);
  if (!stiff) return std::nullopt;
  StiffnessBound bound = stiff->stiffest;
  const std::vector<double>& sum = stiff->sum;
  const double largest = sum.empty() ? 0.0 : *std::max_element(sum.begin(), sum.end());
  if (largest == 0.0) return bound;
  // Over the largest d, against overflow; and a trifle, so that none is 0.
  std::vector<double> weight(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i) weight[i] = sum[i] / largest + 1e-290;
  std::vector<double> others(sum.size(), 0.0);  // sum of k p(j)
  const double* k = stiff->of_bond.data();
  problem.bonds.for_each_bond([&](std::size_t i, std::size_t j, std::size_t) {
    others[i] += *k * weight[j];
    others[j] += *k * weight[i];
    ++k;
  });
  for (std::size_t i = 0; i < sum.size(); ++i) {
    bound.lambda = std::max(bound.lambda, sum[i] + others[i] / weight[i]);
  }
  bound.lambda *= 1.0 + 1e-14;  // the sums' own rounding: some 20 of 1e-16
  return std::isfinite(bound.lambda) ? std::optional(bound) : std::nullopt;
}

std::optional<FastestVibration> fastest_vibration(const Problem& problem, const State& state) {
  const auto bound = stiffness_bound(problem, state);
  if (!bound) return std::nullopt;
  if (state.size() <= lanczos_particles) {
    const double tolerance = state.size() <= small_ball ? fine_tolerance : coarse_tolerance;
    if (const auto lambda = largest_eigenvalue(bond_hessian(problem, state), tolerance)) {
      return FastestVibration{std::sqrt(std::max(*lambda, 0.0)), true, *bound};
    }
  }
  return FastestVibration{std::sqrt(bound->lambda), false, *bound};
}

}  // namespace bounce
