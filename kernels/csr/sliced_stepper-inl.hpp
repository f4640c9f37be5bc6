// What the kernels csr and strict share: any neighbour list, particles side by side in vectors,
// threads over slices. A slice is as many particles as a vector has lanes (slices.hpp draws one);
// its physics is a parameter.
//
// Why it is built so
//  1. Both directions of a bond are computed: a particle's sum is its own, nothing is written by
//     two lanes or two threads, and its order is that of its row, whoever computes it.
//  2. Positions stand twice (ParticleStore): a pass reads the one copy and writes the other.
//     Threads meet once a stage, at the end.
//  3. Neighbours of consecutive particles are mostly consecutive themselves (slices.hpp): then a
//     plain load replaces the gather, in any list, found entry by entry.
#if defined(BOUNCE_SLICED_STEPPER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_SLICED_STEPPER_INL_HPP
#undef BOUNCE_SLICED_STEPPER_INL_HPP
#else
#define BOUNCE_SLICED_STEPPER_INL_HPP
#endif

#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "kernels/csr/slices.hpp"
#include "kernels/stepping/particle_store.hpp"
#include "kernels/stepping/staged_stepper.hpp"
#include "kernels/stepping/threads.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A stage's constants for every combination of classes: a vector each of attraction, repulsion and
/// 1 where a lane has the bond, 0 where not.
struct CombinationTable {
  AlignedArray attraction, repulsion, present;
  double gx = 0.0, gy = 0.0, drift = 0.0;

  CombinationTable(const SlicedBonds& bonds, const StageConstants& stage)
      : attraction(bonds.combinations.size()),
        repulsion(bonds.combinations.size()),
        present(bonds.combinations.size()),
        gx(stage.gravity.x),
        gy(stage.gravity.y),
        drift(stage.drift) {
    for (size_t i = 0; i < bonds.combinations.size(); ++i) {
      if (bonds.combinations[i] == no_bond) continue;
      const BondClass& kick = stage.kick[static_cast<size_t>(bonds.combinations[i])];
      attraction[i] = kick.attraction;
      repulsion[i] = kick.repulsion;
      present[i] = 1.0;
    }
  }
};

/// Positions of the neighbours of one entry.
template <class D>
HWY_INLINE void load_neighbours(D d, const SlicedBonds& bonds, const SliceEntry& entry,
                                const double* x, const double* y, hn::Vec<D>& nx, hn::Vec<D>& ny) {
  if (HWY_LIKELY(entry.first >= 0)) {
    nx = hn::LoadU(d, x + entry.first);
    ny = hn::LoadU(d, y + entry.first);
  } else {
    const hn::RebindToSigned<D> di;
    const auto place = static_cast<size_t>(-1 - entry.first) * hn::Lanes(d);
    const auto index = hn::LoadU(di, bonds.scattered.data() + place);
    nx = hn::GatherIndex(d, x, index);
    ny = hn::GatherIndex(d, y, index);
  }
}

/// Physics: constructed from the problem; `slice(table, bonds, slice, at, x, y, store, nx, ny)`
/// moves the particles from `at` on, reading all positions in x, y and writing their new ones to
/// nx, ny; `mirror_at_walls(table, at, vectors, store, nx, ny)` follows after some slices, so that
/// nothing need be called among them.
template <class Physics>
class SlicedStepper final : public StagedStepper {
  using D = typename Physics::D;
  static constexpr size_t L = hn::MaxLanes(D());
  static constexpr size_t chunk = 64;  // slices; what they moved is in L1 when walls are looked at

 public:
  SlicedStepper(const Problem& start, int threads)
      : StagedStepper(start),
        physics_(model()),
        bonds_(slice_bonds(start.bonds, static_cast<int>(L))),
        store_(start.initial.size()),
        threads_(threads) {
    SlicedStepper::write(start.initial);
  }

 protected:
  HWY_NOINLINE void run(std::span<const StageConstants> stages, std::int64_t steps) override {
    std::vector<CombinationTable> tables;
    for (const StageConstants& stage : stages) {
      tables.emplace_back(bonds_, physics_.scaled() ? stage : unscaled(stage));
    }
    step(tables, steps);
  }

  void read(State& state) const override { store_.read(state); }

  void write(const State& state) override { store_.write(state); }

 private:
  HWY_NOINLINE void step(const std::vector<CombinationTable>& tables, std::int64_t steps) {
    const size_t count = bonds_.slices.size();
    const std::int64_t passes = steps * static_cast<std::int64_t>(tables.size());
    if (threads_ == 1) {
      for (std::int64_t n = 0; n < passes; ++n) pass(tables, n, 0, count);
    } else {
      std::optional<SpinBarrier> barrier;
#pragma omp parallel num_threads(threads_)
      {
        const auto team = static_cast<size_t>(omp_get_num_threads());
        const auto me = static_cast<size_t>(omp_get_thread_num());
#pragma omp single
        barrier.emplace(static_cast<int>(team));
        for (std::int64_t n = 0; n < passes; ++n) {
          pass(tables, n, count * me / team, count * (me + 1) / team);
          barrier->meet(n + 1);
        }
      }
    }
    store_.current ^= static_cast<int>(passes & 1);
  }

  // strict multiplies by dt after it has summed, as the listing does.
  [[nodiscard]] StageConstants unscaled(StageConstants stage) const {
    stage.kick = model().classes;
    stage.gravity = model().gravity;
    return stage;
  }

  HWY_INLINE void pass(const std::vector<CombinationTable>& tables, std::int64_t n, size_t begin,
                       size_t end) {
    const CombinationTable& table = tables[static_cast<size_t>(n) % tables.size()];
    const int from = store_.current ^ static_cast<int>(n & 1);
    const double* x = store_.x[from].data();
    const double* y = store_.y[from].data();
    double* new_x = store_.x[from ^ 1].data();
    double* new_y = store_.y[from ^ 1].data();
    for (size_t s = begin; s < end; s += chunk) {
      const size_t chunk_end = std::min(s + chunk, end);
      for (size_t i = s; i < chunk_end; ++i) {
        physics_.slice(table, bonds_, bonds_.slices[i], i * L, x, y, store_, new_x, new_y);
      }
      physics_.mirror_at_walls(table, s * L, chunk_end - s, store_, new_x, new_y);
    }
  }

  Physics physics_;
  SlicedBonds bonds_;
  ParticleStore store_;
  int threads_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
