#include "kernels/contact/method_flow.hpp"

#include <algorithm>
#include <cstddef>

namespace bounce {

void MethodFlow::retake(double h) {
  end_ = start_;
  const std::size_t half = end_.size() / 2;
  double* const place = end_.data();
  double* const velocity = end_.data() + half;
  for (const Stage& stage : stages_) {
    if (stage.kick != 0.0) {
      const double* const acceleration = evaluate().data();
      const double kick = stage.kick * h;
      for (std::size_t k = 0; k < half; ++k) velocity[k] += kick * acceleration[k];
    }
    const double drift = stage.drift * h;
    if (drift == 0.0) continue;
    for (std::size_t k = 0; k < half; ++k) place[k] += drift * velocity[k];
  }
}

const std::vector<double>& MethodFlow::evaluate() {
  const std::size_t half = end_.size() / 2, n = half / 2;
  if (at_.size() != half || !std::equal(at_.begin(), at_.end(), end_.begin())) {
    ++evaluations_;
    at_.assign(end_.begin(), end_.begin() + static_cast<std::ptrdiff_t>(half));
    forces_(end_.data(), end_.data() + n, pull_.data(), pull_.data() + n);
  }
  if (resting_->particles().empty()) return pull_;
  held_ = pull_;
  resting_->hold(held_.data(), held_.data() + n);
  return held_;
}

}  // namespace bounce
