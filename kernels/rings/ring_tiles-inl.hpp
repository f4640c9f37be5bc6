// A large ball of rings in tiles: runs of columns, each of which is stepped several stages at a
// time, alone and within cache (ring_columns-inl.hpp has what a column is, and its left sums).
//
// Why it is built so
//  1. A tile of n columns has g ghost columns at either side, copies of its neighbours' columns. A
//     stage spoils the outermost one of each side, so g stages are taken before the ghosts have to
//     be copied anew: stage s of them moves columns -(g-1-s) .. n+(g-1-s).
//  2. A column's stage needs the stage before on itself and on the next column; of the column
//     before only the left sums, which the sweep carries. So stage s may follow stage s - 1 one
//     column behind it, and a column is loaded once for all stages:
//
//         columns   ... [stage 2: 32 of them][stage 1: 32    ][stage 0: 32    ] ...
//                        `-- one column later each, then all move on by 32 --'
//
//     The front of g stages and a chunk of 32 columns is 384 (32 + g) bytes with 4 lanes and three
//     rings, 18 kB for g = 16: it stays in L1 however long the tile is, and memory is read and
//     written once for g stages.
//  3. Particles behind a wall are mirrored when their chunk of columns is done: the next column's
//     left sums were taken before, the next stage comes later.
//
// Work beside the whole ball's: g (g - 1) columns of ghosts and g single ones for the first left
// sums, per g stages. What that saves against a plain sweep a stage: results/large-balls.md.
#if defined(BOUNCE_RING_TILES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_TILES_INL_HPP
#undef BOUNCE_RING_TILES_INL_HPP
#else
#define BOUNCE_RING_TILES_INL_HPP
#endif

#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <vector>

#include "kernels/rings/ring_columns-inl.hpp"
#include "kernels/rings/ring_forms-inl.hpp"
#include "kernels/stepping/particle_store.hpp"
#include "kernels/stepping/threads.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

/// Most stages that a tile is stepped alone.
inline constexpr size_t most_ghosts = 16;

/// Columns: a RingColumns.
template <class Columns>
class RingTile {
  using Column = typename Columns::Column;
  using Constants = typename Columns::Constants;
  using Ending = typename Columns::Ending;
  using V = typename Columns::V;
  static constexpr size_t block = Columns::block;
  static constexpr size_t chunk = 32;  // columns; their reciprocals take 7 kB with 4 lanes

 public:
  /// `columns` columns with `ghosts` more at either side, at most most_ghosts.
  RingTile(size_t columns, size_t ghosts)
      : size_(columns),
        ghosts_(ghosts),
        data_((columns + 2 * ghosts) * block),
        u_(Columns::terms * chunk) {}

  [[nodiscard]] size_t size() const { return size_; }
  [[nodiscard]] size_t ghosts() const { return ghosts_; }
  /// Column k, -ghosts() to size() + ghosts() - 1.
  [[nodiscard]] double* column(std::ptrdiff_t k) {
    return data_.data() + static_cast<size_t>(k + static_cast<std::ptrdiff_t>(ghosts_)) * block;
  }
  [[nodiscard]] const double* column(std::ptrdiff_t k) const {
    return data_.data() + static_cast<size_t>(k + static_cast<std::ptrdiff_t>(ghosts_)) * block;
  }

  /// Takes `count` stages, 1 to ghosts(); `count` ghosts beside the tile must be filled.
  HWY_INLINE void advance(const Columns& physics, const Constants* const* stages, size_t count,
                          const std::vector<Wall>& walls) {
    const auto n = static_cast<std::ptrdiff_t>(size_);
    const auto last = static_cast<std::ptrdiff_t>(count) - 1;
    std::ptrdiff_t at[most_ghosts] = {};  // the next column of each stage
    Column left[most_ghosts];             // its left sums
    for (std::ptrdiff_t s = 0; s <= last; ++s) at[s] = s - last;
    for (auto front = chunk_columns - last; at[last] < n; front += chunk_columns) {
      for (std::ptrdiff_t s = 0; s <= last; ++s) {
        const std::ptrdiff_t end = std::min(front - s, n + last - s);
        if (end <= at[s]) continue;
        if (at[s] == s - last) start_left(physics, *stages[s], at[s], left[s]);
        sweep(physics, *stages[s], walls, at[s], end, left[s]);
        at[s] = end;
      }
    }
  }

 private:
  static constexpr auto chunk_columns = static_cast<std::ptrdiff_t>(chunk);

  // The left sums of column k, from the column before it.
  HWY_INLINE void start_left(const Columns& physics, const Constants& c, std::ptrdiff_t k,
                             Column& left) {
    V lowest = Columns::high_up();
    Columns::reciprocals(column(k - 1), 1, u_.data());
    physics.template sums<Ending::drop>(c, column(k - 1), 1, u_.data(), left, lowest);
  }

  // One stage of columns begin .. end - 1, at most a chunk and the ghosts.
  HWY_INLINE void sweep(const Columns& physics, const Constants& c, const std::vector<Wall>& walls,
                        std::ptrdiff_t begin, std::ptrdiff_t end, Column& left) {
    const auto count = static_cast<size_t>(end - begin);
    V lowest = Columns::high_up();
    Columns::reciprocals(column(begin), count, u_.data());
    physics.template sums<Ending::move>(c, column(begin), count, u_.data(), left, lowest);
    Columns::meet_walls(c, walls, column(begin), count, lowest);
  }

  size_t size_, ghosts_;
  AlignedArray data_, u_;
};

/// A ring dealt to tiles, one a thread, which hand each other copies of their outer columns before
/// each visit of several stages. Columns: a RingColumns.
template <class Columns>
class RingTiles {
  using Constants = typename Columns::Constants;
  using Tile = RingTile<Columns>;
  static constexpr size_t block = Columns::block;

 public:
  /// A visit takes `most_stages` stages, fewer where tiles are small.
  RingTiles(size_t columns, size_t tiles, size_t most_stages = most_ghosts) {
    for (size_t t = 0; t <= tiles; ++t) begins_.push_back(columns * t / tiles);
    const size_t ghosts = std::clamp<size_t>(columns / tiles / ghost_part, 1, most_stages);
    for (size_t t = 0; t < tiles; ++t) tiles_.emplace_back(begins_[t + 1] - begins_[t], ghosts);
  }

  [[nodiscard]] double* column(size_t k) {
    const auto behind = std::upper_bound(begins_.begin(), begins_.end(), k);
    const auto t = static_cast<size_t>(behind - begins_.begin()) - 1;
    return tiles_[t].column(static_cast<std::ptrdiff_t>(k - begins_[t]));
  }

  HWY_NOINLINE void run(const Columns& physics, const std::vector<Constants>& constants,
                        const std::vector<Wall>& walls, std::int64_t steps) {
    const size_t tiles = tiles_.size(), ghosts = tiles_.front().ghosts();
    std::vector<Mailbox> boxes(tiles);
    for (size_t t = 0; t < tiles; ++t) {
      for (size_t parity = 0; parity < 2; ++parity) {
        boxes[t].first[parity] = AlignedArray(ghosts * block);
        boxes[t].last[parity] = AlignedArray(ghosts * block);
      }
      publish(boxes[t], tiles_[t], 0);
    }
#pragma omp parallel num_threads(static_cast <int>(tiles))
    {
      // OpenMP may give fewer threads than asked for: then a thread has several tiles.
      const auto team = static_cast<size_t>(omp_get_num_threads());
      const auto me = static_cast<size_t>(omp_get_thread_num());
      const Constants* next[most_ghosts];
      size_t stage = 0;
      std::int64_t visit = 0;
      for (auto left = static_cast<size_t>(steps) * constants.size(); left > 0; ++visit) {
        const size_t count = std::min(left, ghosts);
        for (size_t s = 0; s < count; ++s) {
          next[s] = &constants[stage];
          stage = stage + 1 == constants.size() ? 0 : stage + 1;
        }
        for (size_t t = me; t < tiles; t += team) {
          fill_ghosts(t, boxes, visit);
          tiles_[t].advance(physics, next, count, walls);
          publish(boxes[t], tiles_[t], visit + 1);
        }
        left -= count;
      }
    }
  }

 private:
  // At most this part of a tile's columns is ghosts at either side.
  static constexpr size_t ghost_part = 16;

  // What a tile sends to its neighbours: its outer columns, for even and odd visits.
  struct alignas(64) Mailbox {
    std::atomic<std::int64_t> visits{-1};
    AlignedArray first[2], last[2];
  };

  // Sends the neighbours this tile's outer columns as they are before visit number `visit`.
  static void publish(Mailbox& box, const Tile& tile, std::int64_t visit) {
    const auto parity = static_cast<size_t>(visit & 1);
    const size_t ghosts = tile.ghosts();
    const auto from_last = static_cast<std::ptrdiff_t>(tile.size() - ghosts);
    std::copy_n(tile.column(0), ghosts * block, box.first[parity].data());
    std::copy_n(tile.column(from_last), ghosts * block, box.last[parity].data());
    box.visits.store(visit, std::memory_order_release);
  }

  // Columns from another tile, or, across the seam of the lanes, turned by a lane.
  static HWY_INLINE void take(const AlignedArray& from, size_t ghosts, int shift, double* to) {
    if (shift == 0) {
      std::copy_n(from.data(), ghosts * block, to);
      return;
    }
    for (size_t half = 0; half < 2 * ghosts; ++half) {  // positions and velocities alike
      const size_t at = half * Columns::positions;
      Columns::store(Columns::turn(Columns::load(from.data() + at), shift), to + at);
    }
  }

  // Fills tile t's ghosts with what its neighbours sent.
  HWY_INLINE void fill_ghosts(size_t t, const std::vector<Mailbox>& boxes, std::int64_t visit) {
    const size_t tiles = tiles_.size(), ghosts = tiles_[t].ghosts();
    const auto parity = static_cast<size_t>(visit & 1);
    const Mailbox& before = boxes[(t + tiles - 1) % tiles];
    const Mailbox& behind = boxes[(t + 1) % tiles];
    wait_for(before.visits, visit);
    take(before.last[parity], ghosts, t == 0 ? -1 : 0,
         tiles_[t].column(-static_cast<std::ptrdiff_t>(ghosts)));
    wait_for(behind.visits, visit);
    take(behind.first[parity], ghosts, t + 1 == tiles ? 1 : 0,
         tiles_[t].column(static_cast<std::ptrdiff_t>(tiles_[t].size())));
  }

  std::vector<size_t> begins_;  // first column of each tile, and the end of the last
  std::vector<Tile> tiles_;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
