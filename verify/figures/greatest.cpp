#include "verify/figures/greatest.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bounce {
namespace {

// How many times the estimate of a cubic's error counts.
constexpr double safety = 4.0;
// Looks that a search at the end may take, and one on the way.
constexpr int most_looks = 48;
constexpr int most_looks_now = 8;
// A piece of a course without steps is searched down to this part of itself.
constexpr double least_part = 1e-6;
// Places within a piece at which its bound is looked for.
constexpr int places = 32;

}  // namespace

double Greatest::Piece::at(double u) const {
  const double h = length(), rise = to.value - from.value;
  const double m = from.slope * h, last = to.slope * h;
  return from.value + u * (m + u * ((3.0 * rise - 2.0 * m - last) + u * (m + last - 2.0 * rise)));
}

double Greatest::Piece::second(double u) const {
  const double h = length(), rise = to.value - from.value;
  const double m = from.slope * h, last = to.slope * h;
  return (2.0 * (3.0 * rise - 2.0 * m - last) + 6.0 * u * (m + last - 2.0 * rise)) / (h * h);
}

double Greatest::Piece::third() const {
  const double h = length(), rise = to.value - from.value;
  return 6.0 * ((from.slope + to.slope) * h - 2.0 * rise) / (h * h * h);
}

// The error of a cubic with values and slopes at both ends goes as u^2 (1 - u)^2.
void Greatest::Piece::find_bound() {
  bound = std::max(from.value, to.value);
  bound_at = from.value >= to.value ? 0.0 : 1.0;
  const auto upper = [this](double u) {
    const double swell = 4.0 * u * (1.0 - u);
    return at(u) + error * swell * swell;
  };
  double best = 0.0, highest = -std::numeric_limits<double>::infinity();
  for (int k = 1; k < places; ++k) {
    const double u = static_cast<double>(k) / places;
    if (const double here = upper(u); here > highest) {
      highest = here;
      best = u;
    }
  }
  // A parabola through the highest place and its neighbours, narrowed twice.
  double width = 1.0 / places;
  for (int k = 0; k < 3; ++k) {
    const double left = upper(best - width), right = upper(best + width);
    const double bend = left - 2.0 * highest + right;
    if (!(bend < 0.0)) break;
    const double next = best + std::clamp(0.5 * (left - right) / bend, -1.0, 1.0) * width;
    const double here = upper(next);
    if (here > highest) {
      highest = here;
      best = next;
    }
    width /= 16.0;
    if (!(best > width && best < 1.0 - width)) break;
  }
  if (highest > bound) {
    bound = highest;
    bound_at = best;
  }
}

// What the jumps of derivatives between two neighbours say of a cubic of that length.
double Greatest::jump(const Piece& left, const Piece& right, double length) {
  const double second = std::abs(right.second(0.0) - left.second(1.0));
  const double third = std::abs(right.third() - left.third());
  return safety * length * length * (second / 32.0 + third * length / 384.0);
}

void Greatest::see(const FigurePoint& point, double bend) {
  if (any_ && !(point.value > seen_.value)) return;
  seen_ = point;
  bend_ = bend;
  any_ = true;
  std::erase_if(open_, [this](const Piece& piece) { return !(piece.bound > seen_.value); });
}

std::optional<Greatest::Piece> Greatest::piece_to(const FigurePoint& point,
                                                  const KeptState& from) const {
  if (!any_ || !(point.time > last_.time)) return std::nullopt;
  Piece piece{.from = last_, .to = point, .start = from};
  const double h = piece.length();
  // Without a neighbour: as if that were straight.
  piece.error = pending_ && pending_->to.time == piece.from.time
                    ? jump(*pending_, piece, h)
                    : safety * std::abs(piece.third()) * h * h * h / 384.0;
  return piece;
}

void Greatest::add(const FigurePoint& point, double rounding, const KeptState& from) {
  rounding_ = std::max(rounding_, rounding);
  std::optional<Piece> piece = piece_to(point, from);
  see(point, piece ? piece->second(1.0) : 0.0);
  if (piece && pending_) {
    if (pending_->to.time == piece->from.time) {
      pending_->error = std::max(pending_->error, jump(*pending_, *piece, pending_->length()));
    }
    settle(std::move(*pending_));
  }
  if (piece) pending_ = std::move(piece);
  last_ = point;
}

void Greatest::add_and_search(const FigurePoint& point, double rounding, const LookAgain& again) {
  rounding_ = std::max(rounding_, rounding);
  std::optional<Piece> piece = piece_to(point, {});
  see(point, piece ? piece->second(1.0) : 0.0);
  last_ = point;
  if (!piece) {
    pending_.reset();  // the course is kicked here
    return;
  }
  settle(*piece);
  search(again, most_looks_now);
  for (const Piece& left : open_) leave(left);
  open_.clear();
  pending_ = std::move(piece);
  searched_ = true;
}

void Greatest::settle(Piece piece) {
  piece.find_bound();
  if (piece.bound > seen_.value) keep(std::move(piece));
}

void Greatest::leave(const Piece& piece) {
  left_bound_ = std::max(left_bound_, piece.bound);
  const double value = piece.at(piece.bound_at);
  if (value > left_value_) {
    left_value_ = value;
    left_time_ = piece.from.time + piece.bound_at * piece.length();
    left_bend_ = piece.second(piece.bound_at);
    left_error_ = piece.error;
  }
}

void Greatest::keep(Piece piece) {
  const auto at = std::upper_bound(open_.begin(), open_.end(), piece.bound,
                                   [](double bound, const Piece& p) { return bound > p.bound; });
  open_.insert(at, std::move(piece));
  if (open_.size() > kept_) {
    leave(open_.back());
    open_.pop_back();
  }
}

void Greatest::restart() {
  const FigurePoint last = last_;
  const double rounding = rounding_;
  *this = Greatest(quantum_, kept_);
  rounding_ = rounding;
  last_ = seen_ = last;
  any_ = true;
}

double Greatest::so_far() const {
  double value = seen_.value;
  for (int k = 1; pending_ && k < places; ++k) {
    value = std::max(value, pending_->at(static_cast<double>(k) / places));
  }
  return value;
}

bool Greatest::is_single(const Piece& piece) const { return piece.length() < 1.5 * quantum_; }

// Looks at the piece with the highest bound, where that is, and puts its two parts in its place.
void Greatest::divide(const LookAgain& again) {
  const Piece piece = open_.front();
  open_.erase(open_.begin());
  double time = piece.from.time + piece.bound_at * piece.length();
  if (quantum_ > 0.0) {
    const double first = std::round(piece.from.time / quantum_);
    const double last = std::round(piece.to.time / quantum_);
    time = std::clamp(std::round(time / quantum_), first + 1.0, last - 1.0) * quantum_;
  }
  const FigureLook look = again(time, piece.start);
  Piece left{.from = piece.from, .to = look.point, .start = piece.start};
  Piece right{.from = look.point, .to = piece.to, .start = look.state};
  see(look.point, left.length() > 0.0 ? left.second(1.0) : 0.0);
  for (Piece* part : {&left, &right}) {
    if (!(part->length() > 0.0)) continue;
    part->error = std::min(jump(left, right, part->length()), piece.error);
    part->find_bound();
    if (part->bound > seen_.value) keep(std::move(*part));
  }
}

void Greatest::search(const LookAgain& again, int most_looks) {
  for (int looks = 0; again && looks < most_looks && !open_.empty(); ++looks) {
    const Piece& top = open_.front();
    if (!(top.bound > seen_.value + rounding_)) break;
    const bool at_an_end = top.bound_at < least_part || top.bound_at > 1.0 - least_part;
    const bool ends = quantum_ > 0.0 ? !top.start || is_single(top) : at_an_end;
    if (ends) {
      leave(top);
      open_.erase(open_.begin());
      --looks;
      continue;
    }
    divide(again);
  }
}

Greatest::Result Greatest::result(const LookAgain& again) const {
  Greatest all = *this;
  all.kept_ = kept_ + most_looks;
  if (all.pending_ && !searched_) all.settle(std::move(*all.pending_));
  all.pending_.reset();
  all.search(again, most_looks);
  for (const Piece& piece : all.open_) all.leave(piece);
  Result result{.value = all.seen_.value, .found_to = all.rounding_, .time = all.seen_.time};
  double slope = all.seen_.slope, bend = all.bend_;
  if (all.left_bound_ > result.value) {
    if (all.left_value_ > result.value) {
      result.value = all.left_value_;
      result.time = all.left_time_;
      slope = 0.0;
      bend = all.left_bend_;
    }
    result.found_to += std::max(all.left_bound_ - result.value,
                                std::min(result.value - all.seen_.value, all.left_error_));
  }
  // How far from it the figure may be that much smaller.
  const double steep = std::abs(slope);
  result.time_found_to =
      2.0 * result.found_to /
      (steep + std::sqrt(slope * slope + 2.0 * std::abs(bend) * result.found_to));
  return result;
}

}  // namespace bounce
