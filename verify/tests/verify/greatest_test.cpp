// The greatest value of a figure between looks: functions whose greatest value is known.
#include "verify/figures/greatest.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace bounce {
namespace {

using Function = std::function<double(double)>;

// Value and slope; a course that is looked at again at whole multiples of `quantum`.
struct Course {
  std::string name;
  Function value, slope;
  double end, look, quantum;
  double greatest, time;  // as they are

  [[nodiscard]] FigurePoint at(double t) const { return {t, value(t), slope(t)}; }
  [[nodiscard]] LookAgain again(int* looks = nullptr) const {
    return [this, looks](double t, const KeptState& from) {
      if (looks != nullptr) ++*looks;
      return FigureLook{at(t), from};
    };
  }
  [[nodiscard]] Greatest looked_at() const {
    Greatest greatest(quantum);
    const KeptState any{Snapshot{}};
    for (std::int64_t k = 0; static_cast<double>(k) * look <= end * (1.0 + 1e-12); ++k) {
      greatest.add(at(static_cast<double>(k) * look), rounding, any);
    }
    return greatest;
  }
  static constexpr double rounding = 1e-14;
};

std::vector<Course> courses() {
  const double pi = std::acos(-1.0);
  return {
      {"parabola", [](double t) { return 3.0 * t - 2.0 * t * t; },
       [](double t) { return 3.0 - 4.0 * t; }, 2.0, 0.4, 1e-6, 9.0 / 8.0, 0.75},
      {"sine", [](double t) { return std::sin(t); }, [](double t) { return std::cos(t); }, 3.0, 0.3,
       1e-6, 1.0, 0.5 * pi},
      {"rises to its end", [](double t) { return t; }, [](double) { return 1.0; }, 2.0, 0.25, 1e-6,
       2.0, 2.0},
      {"falls from its start", [](double t) { return -t * t; }, [](double t) { return -2.0 * t; },
       2.0, 0.25, 1e-6, 0.0, 0.0},
      // Kicked at t = 1.23: the slope turns from 1 to -2.
      {"kick", [](double t) { return t < 1.23 ? t : 1.23 - 2.0 * (t - 1.23); },
       [](double t) { return t < 1.23 ? 1.0 : -2.0; }, 2.0, 0.25, 1e-6, 1.23, 1.23},
      // A vibration eight times as fast as it is looked at, on a slow one.
      {"fast on slow", [](double t) { return std::sin(t) + 1e-3 * std::sin(200.0 * t); },
       [](double t) { return std::cos(t) + 0.2 * std::cos(200.0 * t); }, 3.0, 0.25, 1e-6, 0.0, 0.0},
  };
}

// By brute force where no formula stands above.
double greatest_of(const Course& course) {
  if (course.greatest != 0.0 || course.name != "fast on slow") return course.greatest;
  double greatest = -1.0;
  for (int k = 0; k <= 3'000'000; ++k) greatest = std::max(greatest, course.value(1e-6 * k));
  return greatest;
}

// Half of the greatest second derivative, 41, over half a microsecond squared.
double known_to(const Course& course) { return course.name == "fast on slow" ? 6e-12 : 0.0; }

TEST(Greatest, IsFoundBetweenTheLooks) {
  for (const Course& course : courses()) {
    int looks = 0;
    const Greatest::Result found = course.looked_at().result(course.again(&looks));
    const double truth = greatest_of(course);
    EXPECT_LE(std::abs(found.value - truth), found.found_to + known_to(course)) << course.name;
    EXPECT_LE(found.found_to, course.name == "kick" ? 1e-5 : 1e-9) << course.name;
    EXPECT_LE(looks, 48) << course.name;
    if (course.name == "fast on slow") continue;
    EXPECT_LE(std::abs(found.time - course.time), found.time_found_to + 1e-15) << course.name;
  }
}

// From looks alone it is known less well, and says so.
TEST(Greatest, SaysWhatLooksAloneLeaveOpen) {
  for (const Course& course : courses()) {
    const Greatest::Result found = course.looked_at().result();
    EXPECT_LE(std::abs(found.value - greatest_of(course)), found.found_to + known_to(course))
        << course.name;
  }
}

// A cubic is its own: nothing is looked at again.
TEST(Greatest, NeedsNoLookWhereTheCubicIsRight) {
  for (const Course& course : courses()) {
    if (course.name != "rises to its end" && course.name != "falls from its start") continue;
    int looks = 0;
    static_cast<void>(course.looked_at().result(course.again(&looks)));
    EXPECT_EQ(looks, 0) << course.name;
  }
}

TEST(Greatest, StepsThatCanBeMadeAnewAreSearchedAtOnce) {
  for (const Course& course : courses()) {
    if (course.name == "fast on slow") continue;
    Greatest greatest;
    for (std::int64_t k = 0; static_cast<double>(k) * course.look <= course.end; ++k) {
      greatest.add_and_search(course.at(static_cast<double>(k) * course.look), 1e-14,
                              course.again());
    }
    const Greatest::Result found = greatest.result();
    EXPECT_LE(std::abs(found.value - greatest_of(course)), found.found_to) << course.name;
    EXPECT_LE(found.found_to, course.name == "kick" ? 0.1 : 1e-9) << course.name;
  }
}

TEST(Greatest, BeginsAnewWhereItIsTold) {
  Greatest greatest(1e-6);
  for (const double t : {0.0, 1.0, 2.0, 3.0}) greatest.add({t, std::cos(t), -std::sin(t)}, 0.0);
  greatest.restart();
  EXPECT_EQ(greatest.result().value, std::cos(3.0));
  greatest.add({4.0, std::cos(4.0), -std::sin(4.0)}, 0.0);
  EXPECT_EQ(greatest.result().time, 4.0);
}

// Written down and read back it goes on as it was.
TEST(Greatest, GoesOnFromWords) {
  for (const Course& course : courses()) {
    std::vector<std::uint64_t> words;
    WordWriter writer([&words](std::span<const std::uint64_t> some) {
      words.insert(words.end(), some.begin(), some.end());
    });
    const Greatest whole = course.looked_at();
    writer(whole);
    writer.finish();
    Greatest again;
    WordReader reader(words);
    reader(again);
    reader.finish();
    const Greatest::Result a = whole.result(course.again()), b = again.result(course.again());
    EXPECT_EQ(a.value, b.value) << course.name;
    EXPECT_EQ(a.found_to, b.found_to) << course.name;
    EXPECT_EQ(a.time, b.time) << course.name;
  }
}

}  // namespace
}  // namespace bounce
