// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>

#include "base/input_error.hpp"
#include "host/command_line.hpp"
#include "host/version.hpp"
#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"

namespace {

struct Options {
    std::string first, second, difference;
    int maxChannelDifference = 8;  // [level]
    double maxBadShare = 0.01;
};

/// Compares the pictures. Returns exit status 0 if they are alike, 1 if they differ.
int comparePictures(const Options& options) {
    const pictures::Image first = pictures::readPng(options.first);
    const pictures::Image second = pictures::readPng(options.second);
    pictures::Comparison comparison;
    try {
        comparison = pictures::compare(first, second, options.maxChannelDifference);
    } catch (const base::InputError& error) {
        throw base::InputError(fmt::format("{}, {}: {}", options.first, options.second, error.what()));
    }
    fmt::print("largest channel difference: {}\n", comparison.largestDifference);
    fmt::print("share of pixels that differ by more than {}: {:.6f} ({} of {})\n", options.maxChannelDifference,
               comparison.badShare, comparison.badPixels, first.pixels());
    if (!options.difference.empty()) {
        pictures::writePng(options.difference, pictures::differenceImage(first, comparison));
    }
    return comparison.badShare <= options.maxBadShare ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    if (host::answersVersion(argc, argv, "sandwall-compare")) {
        return 0;
    }
    host::CommandLine line("Compares two pictures. Exit status: 0 alike, 1 different, 2 unusable.", "sandwall-compare");
    Options options;
    line.option("A", options.first, "a PNG").required();
    line.option("B", options.second, "a PNG of the same size").required();
    line.option("--max-channel-diff", options.maxChannelDifference,
                "levels by which a channel may differ before its pixel is bad")
        .range(0, 255)
        .showDefault();
    line.option("--max-bad-share", options.maxBadShare, "share of bad pixels up to which the pictures are alike")
        .range(0.0, 1.0)
        .showDefault();
    line.option("--diff", options.difference, "write a PNG of A, dimmed, with the bad pixels in red");
    return host::runMain(
        line, argc, argv, [&] { return comparePictures(options); }, base::kExitBadInput);
}
