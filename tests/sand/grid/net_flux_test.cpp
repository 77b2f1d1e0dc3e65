// SPDX-License-Identifier: Apache-2.0
#include "sand/grid/net_flux.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sand/grid/settle.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using sand::HeightField;
using sand::grid::NetFlux;

void expectLeadsTo(const HeightField& start, const NetFlux& flux, const HeightField& end) {
    for (int y = 0; y < start.rows(); ++y) {
        for (int x = 0; x < start.columns(); ++x) {
            ASSERT_EQ(start.height(x, y) + flux.rise(x, y), end.height(x, y)) << x << ", " << y;
        }
    }
}

TEST(NetFlux, OfSweepsLeadsFromStartToEnd) {
    constexpr unsigned kSeed = 43;
    std::mt19937 random(kSeed);
    const HeightField start = samples::randomField(70, 45, 1 << 20, random);
    for (const auto rim : {sand::Rim::closed, sand::Rim::open}) {
        sand::Rules rules = samples::flatScene(70, 45).rules;
        rules.rim = rim;
        HeightField field = start;
        sand::grid::Erosion erosion(field, rules);
        NetFlux flux(70, 45);
        while (!erosion.settled()) {
            erosion.sweep(field, 1);
            erosion.addFluxes(flux);
        }
        expectLeadsTo(start, flux, field);
    }
}

TEST(NetFlux, OfSettlingLeadsFromStartToRest) {
    const HeightField start = samples::cylinder(64, 16, 12);
    HeightField field = start;
    NetFlux flux(64, 64);
    EXPECT_GT(settle(field, samples::flatScene(64, 64).rules, &flux).sweeps, 0);
    expectLeadsTo(start, flux, field);
}

}  // namespace
