#include <priormap/core/parallel.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using priormap::ordered_pipeline;
using priormap::parallel_for;

TEST(ParallelForTest, VisitsEachIndexOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    std::vector<std::atomic<int>> visits(1000);
    parallel_for(visits.size(), threads, [&](std::size_t i) { ++visits[i]; });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
  }
  parallel_for(0, 4, [](std::size_t) { FAIL(); });
}

TEST(ParallelForTest, RethrowsTheLowestFailingIndexForAnyThreadCount) {
  for (const int threads : {1, 2, 5}) {
    try {
      parallel_for(100, threads, [](std::size_t i) {
        if (i == 20) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        if (i >= 20) throw std::runtime_error(std::to_string(i));
      });
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "20");
    }
  }
}

TEST(OrderedPipelineTest, ConsumesInOrderWithinTheWindow) {
  for (const int threads : {1, 2, 5}) {
    std::atomic<std::size_t> waiting = 0;
    std::size_t most = 0;
    std::vector<std::size_t> order;
    ordered_pipeline(
        200, threads, 4,
        [&](std::size_t i) {
          ++waiting;
          if (i % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(300));
        },
        [&](std::size_t i) {
          most = std::max<std::size_t>(most, waiting);
          order.push_back(i);
          --waiting;
        });
    ASSERT_EQ(order.size(), 200u);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
    EXPECT_LE(most, 4u);
  }
}

TEST(OrderedPipelineTest, WorkFailureArrivesAfterAllBeforeItAreConsumed) {
  for (const int threads : {1, 3}) {
    std::vector<std::size_t> consumed;
    EXPECT_THROW(ordered_pipeline(
                     50, threads, 8,
                     [](std::size_t i) {
                       if (i == 10) throw std::runtime_error("bad");
                     },
                     [&](std::size_t i) { consumed.push_back(i); }),
                 std::runtime_error);
    EXPECT_EQ(consumed.size(), 10u);
  }
}

TEST(OrderedPipelineTest, ConsumerFailureEndsTheWorkers) {
  EXPECT_THROW(ordered_pipeline(
                   1000, 3, 4, [](std::size_t) {}, [](std::size_t i) { if (i == 5) throw std::runtime_error("full"); }),
               std::runtime_error);
}
