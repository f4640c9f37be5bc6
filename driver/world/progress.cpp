#include "driver/world/progress.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "driver/world/console.hpp"

namespace bounce {
namespace {

constexpr auto interval = std::chrono::milliseconds(100);
constexpr std::int64_t bar_width = 30;  // characters

std::string time_left(double seconds) {
  const auto s = std::llround(seconds);
  if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
  if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} s", s);
}

std::string bar_of(double done) {
  const auto filled = static_cast<std::int64_t>(done * static_cast<double>(bar_width));
  return std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(bar_width - filled), '.');
}

void clear_line() {
  print_err("\r\033[K");  // to the line's start, clear to its end
}

}  // namespace

Progress::Progress(bool on, std::int64_t steps, double step_time)
    : on_(on), steps_(steps), step_time_(step_time) {}

Progress::~Progress() {
  if (drawn_) clear_line();
}

void Progress::update(std::int64_t step) {
  if (!on_ || step == 0) return;
  const auto now = Clock::now();
  if (now - last_ < interval) return;
  last_ = now;
  drawn_ = true;
  const double done = static_cast<double>(step) / static_cast<double>(steps_);
  const double rate =
      static_cast<double>(step) / std::chrono::duration<double>(now - start_).count();
  print_err("\r[{}] {:3.0f} %  t = {:.3f} s  {:.3g} steps/s  {} left\033[K", bar_of(done),
            100.0 * done, static_cast<double>(step) * step_time_, rate,
            time_left(static_cast<double>(steps_ - step) / rate));
}

CaseProgress::CaseProgress(bool on, std::size_t cases, double work)
    : on_(on), cases_(cases), work_(work) {
  if (on_) print_err("\r[{}]   0 %  0 of {} cases", bar_of(0.0), cases_);
}

CaseProgress::~CaseProgress() {
  if (on_) clear_line();
}

void CaseProgress::update(std::size_t cases, double work) {
  if (!on_ || !(work > 0.0)) return;
  const double done = std::min(work / work_, 1.0);
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  print_err("\r[{}] {:3.0f} %  {} of {} cases  {} left\033[K", bar_of(done), 100.0 * done, cases,
            cases_, time_left(seconds * (1.0 - done) / done));
}

}  // namespace bounce
