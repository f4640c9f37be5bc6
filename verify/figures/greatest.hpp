// The greatest value of a figure over a course that is looked at from time to time, with value and
// slope at each look.
//
//  1. Between two looks lies a cubic. How far the figure may be off it is estimated from how second
//     and third derivatives jump from one cubic to the next: for a smooth course that is the cubic's
//     own error (f'''' h^4/384), for a course that is kicked, or that vibrates faster than it is
//     looked at, some times the size of the kick or of the vibration. The estimate counts four times.
//  2. So each piece has a bound. A piece whose bound is below a value that was seen is done with.
//     The others are kept, and searched at the end, the one with the highest bound first: looked at
//     where the bound is highest, and divided there, until no bound is above what was seen by more
//     than roundings, or the pieces are as short as can be. Most are overtaken by later looks before that.
//  3. Where nothing can be looked at again (a ball too large to keep its states), or too often, what
//     the bounds leave open is part of found_to().
//
// For a smallest value values and slopes are added with the other sign.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernels/stepping/stepper.hpp"
#include "verify/watch/words.hpp"

namespace bounce {

/// A snapshot that several may keep; it never changes. May be null.
class KeptState {
 public:
  KeptState() = default;
  explicit KeptState(Snapshot snapshot)
      : snapshot_(std::make_shared<const Snapshot>(std::move(snapshot))) {}
  [[nodiscard]] explicit operator bool() const { return snapshot_ != nullptr; }
  const Snapshot& operator*() const { return *snapshot_; }
  const Snapshot* operator->() const { return snapshot_.get(); }
  template <class Words>
  void serialize(Words& words) {
    std::optional<Snapshot> copy;
    if (snapshot_) copy = *snapshot_;
    words(copy);
    if constexpr (std::is_same_v<Words, WordReader>) {
      snapshot_ = copy ? std::make_shared<const Snapshot>(std::move(*copy)) : nullptr;
    }
  }

 private:
  std::shared_ptr<const Snapshot> snapshot_;
};

/// A figure at a time: s, its unit, its unit a second.
struct FigurePoint {
  double time = 0.0, value = 0.0, slope = 0.0;
  template <class Words>
  void serialize(Words& words) {
    words(time, value, slope);
  }
};

/// What is found when a course is looked at again, and the state there, for going on from.
struct FigureLook {
  FigurePoint point;
  KeptState state;
};
/// Looks at a course again, at a time after that of the state.
using LookAgain = std::function<FigureLook(double time, const KeptState& from)>;

class Greatest {
 public:
  /// `quantum`: s, times are whole multiples of it; 0: any times. `kept`: pieces to keep at most.
  explicit Greatest(double quantum = 0.0, std::size_t kept = 8) : quantum_(quantum), kept_(kept) {}

  /// The next look; `from`: the state at the look before. `rounding`: of values. A look at the same
  /// time as the one before begins a new piece (the slope jumps there).
  void add(const FigurePoint& point, double rounding, const KeptState& from = {});
  /// The same where the course can be looked at again now and not later, between the look before
  /// and this one.
  void add_and_search(const FigurePoint& point, double rounding, const LookAgain& again);
  /// Forgets all but the last look.
  void restart();

  struct Result {
    double value = 0.0, found_to = 0.0;
    double time = 0.0, time_found_to = 0.0;
  };
  /// `again`: empty where nothing can be looked at again.
  [[nodiscard]] Result result(const LookAgain& again = {}) const;
  /// The greatest value seen or, by the cubic, between the last two looks.
  [[nodiscard]] double so_far() const;

  template <class Words>
  void serialize(Words& words) {
    words(quantum_, kept_, rounding_, seen_, bend_, any_, last_, pending_, searched_, open_,
          left_bound_, left_value_, left_time_, left_bend_, left_error_);
  }

 private:
  // A cubic from one point to another, u from 0 to 1.
  struct Piece {
    FigurePoint from, to;
    KeptState start;
    double error = 0.0;  // of the cubic, at its middle
    double bound = 0.0, bound_at = 0.0;
    [[nodiscard]] double length() const { return to.time - from.time; }
    [[nodiscard]] double at(double u) const;
    [[nodiscard]] double second(double u) const;
    [[nodiscard]] double third() const;
    void find_bound();
    template <class Words>
    void serialize(Words& words) {
      words(from, to, start, error, bound, bound_at);
    }
  };
  static double jump(const Piece& left, const Piece& right, double length);
  [[nodiscard]] std::optional<Piece> piece_to(const FigurePoint& point,
                                              const KeptState& from) const;
  void see(const FigurePoint& point, double bend);
  void settle(Piece piece);
  void keep(Piece piece);
  void leave(const Piece& piece);
  void search(const LookAgain& again, int most_looks);
  void divide(const LookAgain& again);
  [[nodiscard]] bool is_single(const Piece& piece) const;

  double quantum_;
  std::size_t kept_;
  double rounding_ = 0.0;
  FigurePoint seen_;   // the greatest value looked at
  double bend_ = 0.0;  // second derivative there
  bool any_ = false;
  FigurePoint last_;
  std::optional<Piece> pending_;  // the last piece, whose right neighbour is not known yet
  bool searched_ = false;         // the last piece is done with
  std::vector<Piece> open_;       // falling bound
  // Of what is left open for good: its highest bound, the highest value of a cubic, when, the
  // second derivative there and the cubic's error.
  double left_bound_ = -std::numeric_limits<double>::infinity();
  double left_value_ = -std::numeric_limits<double>::infinity();
  double left_time_ = 0.0, left_bend_ = 0.0, left_error_ = 0.0;
};

}  // namespace bounce
