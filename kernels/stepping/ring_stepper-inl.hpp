// ring: concentric rings with constant offsets, by sweeps over their columns (ring_columns-inl.hpp
// says how a column is computed and why).
//
// One thread: the ring is one run of columns with a ghost behind it, column 0 turned by a lane.
// Column 0 waits for the end of a stage, when its left sums arrive from column K - 1. The first
// sweep begins with column 1: column 0, moved last in the stage before, is wanted late, so the
// stages overlap.
//
// More threads: the columns are dealt to tiles, a tile a thread, each with a ghost at either side.
// Neighbours hand each other their outer columns before each stage; a tile computes the column
// before it once more, just for its left sums.
//
// Columns are swept in chunks whose reciprocals stay in L1 beside them.
#if defined(BOUNCE_RING_STEPPER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_STEPPER_INL_HPP
#undef BOUNCE_RING_STEPPER_INL_HPP
#else
#define BOUNCE_RING_STEPPER_INL_HPP
#endif

#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "kernels/stepping/particle_store.hpp"
#include "kernels/stepping/ring_columns-inl.hpp"
#include "kernels/stepping/spin.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// D: Highway's tag with the lanes to use. Law, Walls: the form the scene needs. R: rings.
template <class D, class Law, class Walls, int R>
class RingStepper final : public StagedStepper {
  using Columns = RingColumns<D, Law, Walls, R>;
  using Column = typename Columns::Column;
  using Constants = typename Columns::Constants;
  using Rest = typename Columns::Rest;
  using V = hn::Vec<D>;
  static constexpr size_t L = Columns::L;
  static constexpr size_t block = Columns::block;
  static constexpr size_t chunk = 32;  // columns; their reciprocals take 7 kB with 4 lanes

 public:
  RingStepper(const Problem& start, const RingShape& shape, int threads)
      : StagedStepper(start),
        physics_(shape, start.law),
        columns_(static_cast<size_t>(shape.per_ring) / L) {
    const auto tiles = static_cast<size_t>(threads);
    for (size_t t = 0; t < tiles; ++t) {
      tiles_.emplace_back(columns_ * t / tiles, columns_ * (t + 1) / tiles);
    }
    RingStepper::write(start.initial);
  }

 protected:
  HWY_NOINLINE void run(std::span<const StageConstants> stages, std::int64_t steps) override {
    std::vector<Constants> constants;
    for (const StageConstants& stage : stages) {
      constants.push_back(physics_.make_constants(stage));
    }
    if (tiles_.size() > 1) {
      run_team(constants, steps);
      return;
    }
    const Walls walls(problem().walls);
    for (std::int64_t s = 0; s < steps; ++s) {
      for (const Constants& c : constants) pass(c, walls);
    }
  }

  void read(State& state) const override {
    for (const Tile& tile : tiles_) {
      for (size_t k = tile.begin; k < tile.end; ++k) {
        const double* column = tile.column(k - tile.begin);
        for_each_place(state, k, [&](double& value, size_t place) { value = column[place]; });
      }
    }
  }

  void write(const State& state) override {
    State copy = state;
    for (Tile& tile : tiles_) {
      for (size_t k = tile.begin; k < tile.end; ++k) {
        double* column = tile.column(k - tile.begin);
        for_each_place(copy, k, [&](double& value, size_t place) { column[place] = value; });
      }
    }
  }

 private:
  // Columns begin .. end-1 with a ghost on either side, and the reciprocals of a chunk of them.
  struct Tile {
    size_t begin, end;
    AlignedArray data, u;

    Tile(size_t from, size_t to)
        : begin(from), end(to), data((to - from + 2) * block), u(Columns::terms * (chunk + 1)) {}
    [[nodiscard]] size_t size() const { return end - begin; }
    [[nodiscard]] double* column(size_t k) { return data.data() + (k + 1) * block; }
    [[nodiscard]] const double* column(size_t k) const { return data.data() + (k + 1) * block; }
    [[nodiscard]] double* before() { return data.data(); }
    [[nodiscard]] double* behind() { return column(size()); }
  };

  // What a tile tells its neighbours: its outer columns, for even and odd stages.
  struct alignas(64) Mailbox {
    std::atomic<std::int64_t> stages{-1};
    AlignedArray first[2], last[2];
  };

  // Calls visit(value in the state, its place in the column's block) for all of column k.
  template <class Visit>
  void for_each_place(State& state, size_t k, Visit visit) const {
    std::vector<double>* const arrays[] = {&state.x, &state.y, &state.vx, &state.vy};
    for (size_t row = 0; row < size_t{4} * R; ++row) {
      for (size_t l = 0; l < L; ++l) {
        visit((*arrays[row / R])[((row % R) * L + l) * columns_ + k], row * L + l);
      }
    }
  }

  // One stage of the whole ring by one thread.
  HWY_INLINE void pass(const Constants& c, const Walls& walls) {
    Tile& ring = tiles_.front();
    double* first = ring.column(0);
    double* u = ring.u.data();
    double* u_first = u + chunk * Columns::terms;
    V nearest = Columns::far_away();
    Column left;
    Columns::store(Columns::turn(Columns::load(first), 1), ring.behind());
    for (size_t k = 1; k < columns_; k += chunk) {
      const size_t count = std::min(chunk, columns_ - k);
      Columns::reciprocals(ring.column(k), count, u);
      if (k == 1) {
        Columns::reciprocals(first, 1, u_first);
        physics_.template sums<Rest::keep>(c, walls, first, 1, u_first, left, nearest);
      }
      physics_.template sums<Rest::finish>(c, walls, ring.column(k), count, u, left, nearest);
    }
    physics_.finish_kept(c, walls, first, Columns::turn(left, -1), nearest);
    Columns::mirror_at_walls(walls, first, columns_, nearest);
  }

  // Tells the neighbours where this tile's outer columns stand before stage number `stage`.
  static void publish(Mailbox& box, const Tile& tile, std::int64_t stage) {
    const auto parity = static_cast<size_t>(stage & 1);
    std::copy_n(tile.column(0), Columns::positions, box.first[parity].data());
    std::copy_n(tile.column(tile.size() - 1), Columns::positions, box.last[parity].data());
    box.stages.store(stage, std::memory_order_release);
  }

  // Fills a tile's ghosts with what its neighbours told.
  HWY_INLINE void fill_ghosts(Tile& tile, const Mailbox& before, const Mailbox& behind,
                              std::int64_t stage) const {
    const auto parity = static_cast<size_t>(stage & 1);
    wait_for(before.stages, stage);
    wait_for(behind.stages, stage);
    const Column previous = Columns::load(before.last[parity].data());
    const Column next = Columns::load(behind.first[parity].data());
    Columns::store(tile.begin == 0 ? Columns::turn(previous, -1) : previous, tile.before());
    Columns::store(tile.end == columns_ ? Columns::turn(next, 1) : next, tile.behind());
  }

  // One stage of a tile whose ghosts are filled.
  HWY_INLINE void pass_tile(const Constants& c, const Walls& walls, Tile& tile) const {
    double* u = tile.u.data();
    V nearest = Columns::far_away();
    Column left;
    Columns::reciprocals(tile.before(), 1, u);
    physics_.template sums<Rest::drop>(c, walls, tile.before(), 1, u, left, nearest);
    for (size_t k = 0; k < tile.size(); k += chunk) {
      const size_t count = std::min(chunk, tile.size() - k);
      Columns::reciprocals(tile.column(k), count, u);
      physics_.template sums<Rest::finish>(c, walls, tile.column(k), count, u, left, nearest);
    }
    Columns::mirror_at_walls(walls, tile.column(0), tile.size(), nearest);
  }

  void run_team(const std::vector<Constants>& constants, std::int64_t steps) {
    const size_t tiles = tiles_.size();
    std::vector<Mailbox> boxes(tiles);
    for (size_t t = 0; t < tiles; ++t) {
      for (int parity = 0; parity < 2; ++parity) {
        boxes[t].first[parity] = AlignedArray(Columns::positions);
        boxes[t].last[parity] = AlignedArray(Columns::positions);
      }
      publish(boxes[t], tiles_[t], 0);
    }
#pragma omp parallel num_threads(static_cast <int>(tiles))
    {
      // OpenMP may give fewer threads than asked for: then a thread has several tiles.
      const auto team = static_cast<size_t>(omp_get_num_threads());
      const auto me = static_cast<size_t>(omp_get_thread_num());
      const Walls walls(problem().walls);
      std::int64_t done = 0;
      for (std::int64_t s = 0; s < steps; ++s) {
        for (const Constants& c : constants) {
          for (size_t t = me; t < tiles; t += team) {
            fill_ghosts(tiles_[t], boxes[(t + tiles - 1) % tiles], boxes[(t + 1) % tiles], done);
            pass_tile(c, walls, tiles_[t]);
            publish(boxes[t], tiles_[t], done + 1);
          }
          ++done;
        }
      }
    }
  }

  Columns physics_;
  size_t columns_;  // vectors a ring
  std::vector<Tile> tiles_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
