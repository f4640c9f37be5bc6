// Work shared by threads, and how many there are where nobody asks for a number.
#include "kernels/stepping/threads.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace bounce {
namespace {

constexpr int several = 4;

// What OpenMP is set to while this lives.
class OpenMpThreads {
 public:
  explicit OpenMpThreads(int threads) { omp_set_num_threads(threads); }
  ~OpenMpThreads() { omp_set_num_threads(before_); }
  OpenMpThreads(const OpenMpThreads&) = delete;
  OpenMpThreads& operator=(const OpenMpThreads&) = delete;

 private:
  int before_ = omp_get_max_threads();
};

// Whether the counter comes to the value; gives up in the end, so that a test fails but never
// hangs.
bool reaches(const std::atomic<int>& counter, int value) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (counter.load() < value) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(ParallelFor, TakesEachIndexOnce) {
  for (const int threads : {0, 1, 2, several}) {
    for (const std::size_t count : {0, 1, 3, 1000}) {
      std::vector<std::atomic<int>> calls(count);
      std::atomic<int> outside{0};
      parallel_for(count, threads, [&](std::size_t i) { ++(i < count ? calls[i] : outside); });
      EXPECT_EQ(outside, 0) << threads << " threads, " << count;
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(calls[i], 1) << threads << ", " << i;
    }
  }
}

TEST(ParallelFor, TakesAsManyThreadsAsAskedForAndTheDefaultForNone) {
  const auto team_of = [](int threads) {
    std::atomic<int> team{0};
    parallel_for(100, threads, [&](std::size_t) { team = omp_get_num_threads(); });
    return team.load();
  };
  for (const int threads : {1, 2, several}) EXPECT_EQ(team_of(threads), threads);
  EXPECT_EQ(team_of(0), default_threads());
  for (const int set : {1, omp_get_num_procs(), omp_get_num_procs() + 3}) {
    const OpenMpThreads as_set(set);
    EXPECT_EQ(team_of(0), default_threads()) << set;
    EXPECT_EQ(team_of(0), std::min(set, omp_get_num_procs()));
  }
}

// One index that takes as long as all others together holds none of them up.
TEST(ParallelFor, GivesAnIndexToWhoeverIsFree) {
  constexpr std::size_t count = 100;
  std::atomic<int> others{0};
  parallel_for(count, 2, [&](std::size_t i) {
    if (i == 0) {
      EXPECT_TRUE(reaches(others, count - 1));
    } else {
      ++others;
    }
  });
}

TEST(ParallelFor, BeginsNothingAfterAFailureOfOneThread) {
  for (const std::size_t failing : {0, 3, 9}) {
    std::vector<std::size_t> begun;
    const auto work = [&](std::size_t i) {
      begun.push_back(i);
      if (i == failing) throw std::out_of_range("index " + std::to_string(i));
    };
    try {
      parallel_for(10, 1, work);
      ADD_FAILURE() << "what index " << failing << " threw is lost";
    } catch (const std::out_of_range& thrown) {  // as it was thrown, not a copy of its base
      EXPECT_EQ(thrown.what(), "index " + std::to_string(failing));
    }
    ASSERT_EQ(begun.size(), failing + 1);
    EXPECT_EQ(begun.back(), failing);
  }
}

// Each thread holds one index until all do, so that the thread meant is there to throw.
TEST(ParallelFor, BringsTheCallerWhatAnyThreadThrows) {
  for (int failing = 0; failing < several; ++failing) {
    std::atomic<int> arrived{0};
    const auto work = [&](std::size_t) {
      ++arrived;
      EXPECT_TRUE(reaches(arrived, several));
      if (omp_get_thread_num() == failing) throw std::out_of_range(std::to_string(failing));
    };
    try {
      parallel_for(several, several, work);
      ADD_FAILURE() << "what thread " << failing << " threw is lost";
    } catch (const std::out_of_range& thrown) {
      EXPECT_EQ(thrown.what(), std::to_string(failing));
    }
    EXPECT_EQ(arrived, several);
  }
}

TEST(ParallelFor, BringsTheCallerOneOfSeveralFailures) {
  std::atomic<int> arrived{0};
  const auto work = [&](std::size_t i) {
    ++arrived;
    EXPECT_TRUE(reaches(arrived, several));
    throw i;
  };
  try {
    parallel_for(several, several, work);
    ADD_FAILURE() << "what was thrown is lost";
  } catch (std::size_t thrown) {
    EXPECT_LT(thrown, std::size_t{several});
  }
  // A failure is over with its call.
  std::atomic<int> calls{0};
  EXPECT_NO_THROW(parallel_for(100, several, [&](std::size_t) { ++calls; }));
  EXPECT_EQ(calls, 100);
}

TEST(DefaultThreads, AreNoMoreThanTheProcessors) {
  EXPECT_GE(default_threads(), 1);
  EXPECT_LE(default_threads(), omp_get_num_procs());
}

TEST(UsableCores, AreTheProcessorsOrFewer) {
  const int processors = omp_get_num_procs();
  EXPECT_EQ(usable_cores(), processors);
  for (const int limit : {1, processors, processors + 1}) {
    limit_cores(limit);
    EXPECT_EQ(usable_cores(), std::min(limit, processors));
    EXPECT_LE(default_threads(), limit);
  }
  limit_cores(0);
  EXPECT_EQ(usable_cores(), 1);
  limit_cores(std::numeric_limits<int>::max());
  EXPECT_EQ(usable_cores(), processors);
}

TEST(DefaultThreads, FollowWhatOpenMpIsSetTo) {
  const int before = default_threads();
  const int processors = omp_get_num_procs();
  for (int set = 1; set <= processors; ++set) {
    const OpenMpThreads as_set(set);
    EXPECT_EQ(default_threads(), set);
  }
  {
    const OpenMpThreads too_many(processors + 1);
    EXPECT_EQ(default_threads(), processors);
  }
  EXPECT_EQ(default_threads(), before);
}

}  // namespace
}  // namespace bounce
