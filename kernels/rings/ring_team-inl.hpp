// A ball of rings, or half of one, stepped by a few threads. Each thread has a tile, some
// neighbouring columns, and steps it a stage at a time.
//
// Why it is built so
//  1. A ball of 360 particles takes some 0.4 us a stage, a message from one core to another and
//     back 0.1 to 0.4 us (ring, and the column "hand-shake", in results/throughput.md). So what a
//     tile needs from its neighbours must have been on its way for a whole sweep before it is
//     needed, and must be little.
//  2. The two ghosts of a tile, copies of the columns next to it, are needed at the end of a sweep
//     only. Column 0 is swept first, but moved last, when the sums of its left bonds are known. A
//     tile takes these itself from the column before it, so that only positions have to be sent:
//
//         sweep of a stage:  0 (sums kept)  1  2  ...  n-2 | wait | n-1  0 (left bonds, moved)
//         needed now:                                        columns n and -1 of the stage
//                                                            before, which were sent a sweep ago
//
//  3. Every thread waits for its two neighbours alone, through a counter on a cache line of its
//     own.
//  4. Where the cores are far apart, or a thread has to share one, a team is slower than one
//     thread. On an AMD EPYC, with messages that took 0.11, 0.2 and 0.39 us there and back, it took
//     0.67, 0.8 and 1.0 of one thread's time; with one core for two threads, fifty times as much.
//     So the work is done in slices of a millisecond, by the team or by one thread (Whole) as was
//     faster of late; the bits are the same.
//  5. Columns are swept in chunks whose reciprocals stay in L1 beside them.
//
// Work beside the whole ball's: one column's bonds a tile, and two short sweeps.
//
// Not taken: several columns of ghosts and several stages without a message (ring_tiles-inl.hpp:
// right for large tiles; on 15 columns the ghosts, and sending four vectors a particle, cost as
// much as they save); waiting before the first column instead of before the last one (slower).
#if defined(BOUNCE_RING_TEAM_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BOUNCE_RING_TEAM_INL_HPP
#undef BOUNCE_RING_TEAM_INL_HPP
#else
#define BOUNCE_RING_TEAM_INL_HPP
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>
#include <vector>

#include "kernels/rings/faster_of_two.hpp"
#include "kernels/rings/ring_columns-inl.hpp"
#include "kernels/rings/ring_forms-inl.hpp"
#include "kernels/stepping/particle_store.hpp"
#include "kernels/stepping/threads.hpp"

HWY_BEFORE_NAMESPACE();
namespace bounce {
namespace HWY_NAMESPACE {

/// Columns: a RingColumns. Whole: all columns as one thread steps them, and what is beyond their
/// ends: RingLoop or MirrorHalf.
template <class Columns, class Whole>
class RingTeam {
  using Column = typename Columns::Column;
  using Constants = typename Columns::Constants;
  using Ending = typename Columns::Ending;
  using V = typename Columns::V;
  static constexpr size_t block = Columns::block;
  static constexpr size_t chunk = 32;  // columns; their reciprocals take 7 kB with 4 lanes

 public:
  /// A tile a thread, of at least fewest_columns.
  RingTeam(Whole whole, size_t tiles) : whole_(std::move(whole)) {
    const size_t columns = whole_.size();
    for (size_t t = 0; t < tiles; ++t) {
      tiles_.emplace_back(columns * t / tiles, columns * (t + 1) / tiles);
    }
  }

  static constexpr size_t fewest_columns = std::max<size_t>(2, Whole::sent);

  [[nodiscard]] double* column(size_t k) { return whole_.column(k); }
  /// Holds the columns between two calls of run().
  [[nodiscard]] Whole& whole() { return whole_; }

  void run(const Columns& physics, const std::vector<Constants>& constants,
           const std::vector<Wall>& walls, std::int64_t steps) {
    using Clock = std::chrono::steady_clock;
    while (steps > 0) {
      const std::int64_t slice = std::min(steps, slice_);
      const int way = choice_.next();
      const auto start = Clock::now();
      if (way == alone) {
        whole_.run(physics, constants, walls, slice);
      } else {
        run_together(physics, constants, walls, slice);
      }
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      steps -= slice;
      if (4 * slice < slice_) continue;  // too short to compare
      choice_.took(way, seconds / static_cast<double>(slice));
      if (slice == slice_ && seconds < 0.5 * slice_seconds) slice_ *= 2;
    }
  }

 private:
  static constexpr int alone = 0;
  static constexpr double slice_seconds = 1e-3;

  // Columns begin .. end-1 with a ghost on either side, and the reciprocals of a chunk of them.
  struct Tile {
    size_t begin, end;
    AlignedArray data, u;

    Tile(size_t from, size_t to)
        : begin(from), end(to), data((to - from + 2) * block), u(Columns::terms * (chunk + 2)) {}
    [[nodiscard]] size_t size() const { return end - begin; }
    [[nodiscard]] double* column(size_t k) { return data.data() + (k + 1) * block; }
    [[nodiscard]] double* before() { return data.data(); }
    [[nodiscard]] double* behind() { return column(size()); }
  };

  // What a tile sends to its neighbours: the positions of its outer columns, for even and odd
  // stages.
  struct alignas(64) Mailbox {
    std::atomic<std::int64_t> stage{-1};
    alignas(64) double first[2][Whole::sent][Columns::positions];
    alignas(64) double last[2][Whole::sent][Columns::positions];
  };
  using Sent = const double * [Whole::sent];

  HWY_NOINLINE void run_together(const Columns& physics, const std::vector<Constants>& constants,
                                 const std::vector<Wall>& walls, std::int64_t steps) {
    const size_t tiles = tiles_.size();
    std::vector<Mailbox> boxes(tiles);
    for (size_t t = 0; t < tiles; ++t) {
      Tile& tile = tiles_[t];
      std::copy_n(whole_.column(tile.begin), tile.size() * block, tile.column(0));
      mend(t);
      publish(boxes[t], tile, 0);
    }
#pragma omp parallel num_threads(static_cast <int>(tiles))
    {
      // OpenMP may give fewer threads than asked for: then a thread has several tiles.
      const auto team = static_cast<size_t>(omp_get_num_threads());
      const auto me = static_cast<size_t>(omp_get_thread_num());
      std::int64_t stage = 0;
      for (std::int64_t s = 0; s < steps; ++s) {
        for (const Constants& c : constants) {
          for (size_t t = me; t < tiles; t += team) {
            pass(physics, c, walls, t, boxes, stage);
            mend(t);
            publish(boxes[t], tiles_[t], stage + 1);
          }
          ++stage;
        }
      }
    }
    for (Tile& tile : tiles_) {
      std::copy_n(tile.column(0), tile.size() * block, whole_.column(tile.begin));
    }
  }

  HWY_INLINE void mend(size_t t) {
    if (t == 0) whole_.mend_first(tiles_[t].column(0));
    if (t + 1 == tiles_.size()) whole_.mend_last(tiles_[t].column(tiles_[t].size() - 1));
  }

  // The outermost columns first.
  static HWY_INLINE void publish(Mailbox& box, Tile& tile, std::int64_t stage) {
    const auto parity = static_cast<size_t>(stage & 1);
    for (size_t i = 0; i < Whole::sent; ++i) {
      Columns::store(Columns::load(tile.column(i)), box.first[parity][i]);
      Columns::store(Columns::load(tile.column(tile.size() - 1 - i)), box.last[parity][i]);
    }
    box.stage.store(stage, std::memory_order_release);
  }

  // Fills tile t's ghosts.
  HWY_INLINE void fill_ghosts(size_t t, const std::vector<Mailbox>& boxes, std::int64_t stage) {
    const size_t tiles = tiles_.size();
    const auto parity = static_cast<size_t>(stage & 1);
    const Mailbox& before = boxes[(t + tiles - 1) % tiles];
    const Mailbox& behind = boxes[(t + 1) % tiles];
    wait_for(behind.stage, stage);
    wait_for(before.stage, stage);
    Sent first, last;  // of all columns
    for (size_t i = 0; i < Whole::sent; ++i) {
      first[i] = boxes.front().first[parity][i];
      last[i] = boxes.back().last[parity][i];
    }
    Columns::store(
        t + 1 == tiles ? whole_.behind_last(first, last) : Columns::load(behind.first[parity][0]),
        tiles_[t].behind());
    Columns::store(
        t == 0 ? whole_.before_first(first, last) : Columns::load(before.last[parity][0]),
        tiles_[t].before());
  }

  // One stage of tile t.
  HWY_INLINE void pass(const Columns& physics, const Constants& c, const std::vector<Wall>& walls,
                       size_t t, const std::vector<Mailbox>& boxes, std::int64_t stage) {
    Tile& tile = tiles_[t];
    const size_t last = tile.size() - 1;
    double* u = tile.u.data();
    double* u_before = u + chunk * Columns::terms;
    double* u_first = u_before + Columns::terms;
    Column left, left_of_first;
    V lowest = Columns::high_up();
    size_t k = 1;
    do {
      const size_t count = std::min(chunk, last - k);
      Columns::reciprocals(tile.column(k), count, u);
      if (k == 1) {
        Columns::reciprocals(tile.column(0), 1, u_first);
        physics.template sums<Ending::keep>(c, tile.column(0), 1, u_first, left, lowest);
      }
      physics.template sums<Ending::move>(c, tile.column(k), count, u, left, lowest);
      k += count;
    } while (k < last);
    fill_ghosts(t, boxes, stage);
    Columns::reciprocals(tile.column(last), 1, u);
    Columns::reciprocals(tile.before(), 1, u_before);
    physics.template sums<Ending::move>(c, tile.column(last), 1, u, left, lowest);
    physics.template sums<Ending::drop>(c, tile.before(), 1, u_before, left_of_first, lowest);
    physics.finish_kept(c, tile.column(0), left_of_first, lowest);
    Columns::meet_walls(c, walls, tile.column(0), tile.size(), lowest);
  }

  Whole whole_;
  std::vector<Tile> tiles_;
  FasterOfTwo choice_;
  std::int64_t slice_ = 256;  // steps
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
}  // namespace HWY_NAMESPACE
}  // namespace bounce
HWY_AFTER_NAMESPACE();

#endif
