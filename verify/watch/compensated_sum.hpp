// Sums of many terms, good to the last digit.
#pragma once

namespace bounce {

/// A sum with the rounding errors kept aside (Neumaier, ZAMM 54 (1974) 39), found without a branch
/// (Knuth's two-sum): signs of the terms are as good as random here.
class CompensatedSum {
 public:
  void add(double term) {
    const double sum = sum_ + term;
    const double added = sum - sum_;
    lost_ += (sum_ - (sum - added)) + (term - added);
    sum_ = sum;
  }
  [[nodiscard]] double value() const { return sum_ + lost_; }
  template <class Words>
  void serialize(Words& words) {
    words(sum_, lost_);
  }

 private:
  double sum_ = 0.0;
  double lost_ = 0.0;
};

}  // namespace bounce
