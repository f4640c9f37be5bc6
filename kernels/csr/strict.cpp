// strict: the listing's operations in the listing's order, on vectors: the same bits as the oracle.
//
// Why it is built so (sliced_stepper-inl.hpp says how particles, slices and threads are laid out)
//  1. A lane does for its particle what the listing does for one: R = dx dx + dy dy;
//     F = (-G + H/R)/R; (F dx)/R; sums from left to right in the order of the row; gravity; kick;
//     drift; wall. Four divisions an entry, no fused multiply-add: it is as slow as that is.
//  2. Sums start at -0.0, the one number to which anything can be added without changing it; a lane
//     without an entry keeps its sum (a blend: adding a zero would lose the sign of -0.0).
//  3. Walls are written like the oracle's: the X axis as the listing has it, others in their own
//     axes.
//
// Not taken: sharing divisions, or any algebra that rounds differently. That is csr's and ring's.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/csr/strict.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "kernels/csr/sliced_stepper-inl.hpp"
#include "kernels/csr/strict.hpp"
#include "kernels/model/wall_rule.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

class StrictPhysics {
 public:
  using D = hn::ScalableTag<double>;

  explicit StrictPhysics(const Model& model) : walls_(model.walls), step_(model.step) {}
  // The listing multiplies by the step after it has summed.
  static constexpr bool scaled() { return false; }

  HWY_INLINE void slice(const CombinationTable& table, const SlicedBonds& bonds, const Slice& slice,
                        size_t at, const double* x, const double* y, ParticleStore& store,
                        double* new_x, double* new_y) const {
    const V px = hn::Load(d, x + at), py = hn::Load(d, y + at);
    V ax = hn::Set(d, -0.0), ay = hn::Set(d, -0.0);
    for (std::int32_t k = 0; k < slice.all; ++k) {
      const SliceEntry& entry = bonds.entries[static_cast<size_t>(slice.begin + k)];
      V nx, ny;
      load_neighbours(d, bonds, entry, x, y, nx, ny);
      const auto row = static_cast<size_t>(entry.combination) * hn::Lanes(d);
      const V attraction = hn::Load(d, table.attraction.data() + row);
      const V repulsion = hn::Load(d, table.repulsion.data() + row);
      const V dx = hn::Sub(px, nx), dy = hn::Sub(py, ny);
      const V r = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
      const V f = hn::Div(hn::Add(hn::Neg(attraction), hn::Div(repulsion, r)), r);
      const V sum_x = hn::Add(ax, hn::Div(hn::Mul(f, dx), r));
      const V sum_y = hn::Add(ay, hn::Div(hn::Mul(f, dy), r));
      if (HWY_LIKELY(k < slice.full)) {
        ax = sum_x;
        ay = sum_y;
      } else {
        const auto present = hn::Gt(hn::Load(d, table.present.data() + row), hn::Zero(d));
        ax = hn::IfThenElse(present, sum_x, ax);
        ay = hn::IfThenElse(present, sum_y, ay);
      }
    }
    // Without gravity along x the listing adds nothing there.
    ax = hn::Add(ax, hn::Set(d, table.gx == 0.0 ? -0.0 : table.gx));
    ay = hn::Add(ay, hn::Set(d, table.gy));
    const V dt = hn::Set(d, step_);
    Particles p;
    p.vx = hn::Add(hn::Load(d, store.vx.data() + at), hn::Mul(dt, ax));
    p.vy = hn::Add(hn::Load(d, store.vy.data() + at), hn::Mul(dt, ay));
    p.x = hn::Add(px, hn::Mul(dt, p.vx));
    p.y = hn::Add(py, hn::Mul(dt, p.vy));
    for (const Wall& wall : walls_) {
      const bool x_axis = wall.normal.x == 0.0 && wall.normal.y == 1.0 && wall.offset == 0.0;
      x_axis ? mirror_at_x_axis(wall, p) : mirror(wall, p);
    }
    hn::Store(p.vx, d, store.vx.data() + at);
    hn::Store(p.vy, d, store.vy.data() + at);
    hn::Store(p.x, d, new_x + at);
    hn::Store(p.y, d, new_y + at);
  }

  /// slice() has done so, as the listing does.
  static void mirror_at_walls(const CombinationTable&, size_t, size_t, ParticleStore&, double*,
                              double*) {}

 private:
  using V = hn::Vec<D>;
  static constexpr D d{};
  struct Particles {
    V x, y, vx, vy;
  };

  static HWY_INLINE V times(double factor, V v) {
    return factor == 0.0 ? hn::Zero(d) : hn::Mul(hn::Set(d, factor), v);
  }

  static HWY_INLINE void mirror_at_x_axis(const Wall& wall, Particles& p) {
    const auto clear = hn::Gt(p.y, hn::Zero(d));
    if (HWY_LIKELY(hn::AllTrue(d, clear))) return;
    p.y = hn::IfThenElse(clear, p.y, hn::Neg(p.y));
    p.vx = hn::IfThenElse(clear, p.vx, times(wall.alpha, p.vx));
    p.vy = hn::IfThenElse(clear, p.vy, times(wall.beta, p.vy));
  }

  static HWY_INLINE void mirror(const Wall& wall, Particles& p) {
    const V nx = hn::Set(d, wall.normal.x), ny = hn::Set(d, wall.normal.y);
    const V distance =
        hn::Sub(hn::Add(hn::Mul(nx, p.x), hn::Mul(ny, p.y)), hn::Set(d, wall.offset));
    const auto clear = hn::Gt(distance, hn::Zero(d));
    if (HWY_LIKELY(hn::AllTrue(d, clear))) return;
    const V twice = hn::Mul(hn::Set(d, 2.0), distance);
    const V normal = hn::Add(hn::Mul(nx, p.vx), hn::Mul(ny, p.vy));
    const V tx = hn::Sub(p.vx, hn::Mul(normal, nx)), ty = hn::Sub(p.vy, hn::Mul(normal, ny));
    const V after = hn::Mul(hn::Set(d, wall.beta), normal);
    const V alpha = hn::Set(d, wall.alpha);
    p.x = hn::IfThenElse(clear, p.x, hn::Sub(p.x, hn::Mul(twice, nx)));
    p.y = hn::IfThenElse(clear, p.y, hn::Sub(p.y, hn::Mul(twice, ny)));
    p.vx = hn::IfThenElse(clear, p.vx, hn::Add(hn::Mul(alpha, tx), hn::Mul(after, nx)));
    p.vy = hn::IfThenElse(clear, p.vy, hn::Add(hn::Mul(alpha, ty), hn::Mul(after, ny)));
  }

  const std::vector<Wall>& walls_;
  double step_;
};

std::unique_ptr<Stepper> make_strict(const Problem& problem, int threads) {
  return std::make_unique<SlicedStepper<StrictPhysics>>(problem, threads);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bounce {
namespace {

Preparation prepare_strict(const Problem& problem, const KernelRequest& request,
                           const PrepareInside&) {
  if (!(problem.law.p == 3.0 && problem.law.q == 5.0)) {
    return Refusal{"the listing's operations are those of the law (3, 5)"};
  }
  if (problem.method->name != "listing") {
    return Refusal{"the listing's scheme is the method \"listing\""};
  }
  Plan plan;
  plan.vector = request.vector;
  plan.lanes = lanes_of(plan.vector);
  plan.threads = request.threads == 0 ? 1 : request.threads;
  plan.law = "(3, 5) as the listing writes it";
  plan.walls = "as the listing and the paper write them";
  plan.left_out = {"square root"};
  plan.make_stepper = [&problem, make = BOUNCE_COMPILED_FOR(plan.vector, make_strict),
                       threads = plan.threads] { return make(problem, threads); };
  return plan;
}

}  // namespace

KernelEntry strict_entry() {
  return {.name = "strict",
          .description = "the listing's operations in the listing's order: the oracle's bits",
          .automatic = false,
          .has_listings_bits = true,
          .contacts = {Contact::listing},
          .memory = sliced_memory,
          .prepare = prepare_strict};
}

}  // namespace bounce
#endif
