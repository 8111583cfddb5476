#include "simulation/stock.hpp"

#include <gtest/gtest.h>

namespace kerf::simulation {
namespace {

TEST(Stock, WhatWasCutIsNoLongerInTheWay) {
  Stock stock;
  EXPECT_FALSE(stock.is_uncut({.x = 5, .y = 5, .z = 0}));
  EXPECT_TRUE(stock.is_uncut({.x = 5, .y = 5, .z = -1}));
  stock.cut({.x = 0, .y = 5, .z = -1}, {.x = 10, .y = 5, .z = -1});
  EXPECT_FALSE(stock.is_uncut({.x = 5, .y = 5, .z = -1}));
  EXPECT_TRUE(stock.is_uncut({.x = 5, .y = 5, .z = -1.2}));
  EXPECT_TRUE(stock.is_uncut({.x = 5, .y = 7, .z = -1}));
}

TEST(Stock, AWayInAnotherOrderIsTheSameCut) {
  Stock once;
  once.cut({.x = 0, .y = 0, .z = -1}, {.x = 10, .y = 4, .z = -2});
  Stock pieces;
  pieces.cut({.x = 10, .y = 4, .z = -2}, {.x = 3, .y = 1.2, .z = -1.3});
  pieces.cut({.x = 5, .y = 2, .z = -1.5}, {.x = 0, .y = 0, .z = -1});
  EXPECT_TRUE(compare(once, pieces).none());
}

TEST(Stock, WhatIsMissingAndWhatIsInExcessIsFound) {
  Stock wanted;
  wanted.cut({.x = 0, .y = 0, .z = -1}, {.x = 10, .y = 0, .z = -1});
  Stock is;
  is.cut({.x = 0, .y = 0, .z = -1}, {.x = 8, .y = 0, .z = -1});
  is.cut({.x = 8, .y = 0, .z = -1}, {.x = 8, .y = 2, .z = -1});
  const CutDifference difference = compare(wanted, is);
  EXPECT_NEAR(static_cast<double>(difference.missing_cells), 7, 2);
  EXPECT_NEAR(static_cast<double>(difference.excess_cells), 7, 2);
  EXPECT_GT(difference.missing.x, 8);
  EXPECT_GT(difference.excess.y, 0);
  EXPECT_EQ(compare(wanted, is, 2.5).excess_cells, 0U);
}

TEST(Stock, DepthCounts) {
  Stock wanted;
  wanted.cut({.z = -1}, {.x = 10, .z = -1});
  Stock is;
  is.cut({.z = -0.8}, {.x = 10, .z = -0.8});
  EXPECT_GT(compare(wanted, is).missing_cells, 0U);
  EXPECT_GT(compare(is, wanted).excess_cells, 0U);
  EXPECT_EQ(compare(is, wanted, 0.25).excess_cells, 0U);
}

}  // namespace
}  // namespace kerf::simulation
