#include "engine/geometry/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace sinew {

TEST(Parallel, EveryIndexOnce) {
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    std::vector<int> hits(10007, 0);
    parallel_for(hits.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++hits[i];
    });
    EXPECT_EQ(std::accumulate(hits.begin(), hits.end(), 0), 10007);
    EXPECT_EQ(*std::max_element(hits.begin(), hits.end()), 1);
  }
}

TEST(Parallel, BlocksDoNotDependOnThreads) {
  std::vector<std::vector<std::size_t>> cuts;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    std::vector<std::size_t> cut(8, 0);
    parallel_for(100, 13, [&](std::size_t begin, std::size_t end) { cut[begin / 13] = end; });
    cuts.push_back(cut);
  }
  EXPECT_EQ(cuts[0], cuts[1]);
  EXPECT_EQ(cuts[0].back(), 100u);
}

TEST(Parallel, LowestExceptionComesBackAndTheLoopGoesOnWorking) {
  set_thread_count(2);
  const auto fail = [](std::size_t begin, std::size_t) {
    if (begin >= 20) throw std::runtime_error(std::to_string(begin));
  };
  try {
    parallel_for(100, 10, fail);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "20");
  }
  std::atomic<int> sum = 0;
  parallel_for(100, 10, [&](std::size_t, std::size_t) { ++sum; });
  EXPECT_EQ(sum, 10);
}

TEST(Parallel, ALoopInsideALoopRunsSerially) {
  set_thread_count(2);
  std::atomic<int> sum = 0;
  parallel_for(4, 1, [&](std::size_t, std::size_t) { parallel_for(10, 1, [&](std::size_t, std::size_t) { ++sum; }); });
  EXPECT_EQ(sum, 40);
}

}  // namespace sinew
