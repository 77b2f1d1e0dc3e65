// SPDX-License-Identifier: Apache-2.0
// Fuzzes pieces of the tick track, which a haptic server sends and a journal keeps. They are decoded and encoded again,
// or a replay recomputes their forces on a height field or on a TIN.
#include <algorithm>
#include <array>

#include "haptic_bridge/loop/tick_replay.hpp"
#include "haptic_bridge/loop/tick_track.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace {

using haptic_bridge::TickReplay;
using haptic_bridge::TrackPiece;

void takePiece(fuzz::Input bytes) {
    // Compares bytes, because a tick may hold numbers that are not equal to themselves.
    const base::Bytes once = encode(haptic_bridge::decodeTrackPiece(bytes));
    fuzz::require(encode(haptic_bridge::decodeTrackPiece(once)) == once,
                  "a piece of the tick track differs after it is encoded and decoded");
}

/// Returns how many ticks a replay must feel or leave out: those behind the first header, of the latest sitting.
std::size_t ticksOf(const std::vector<base::Bytes>& pieces) {
    std::size_t count = 0;
    std::uint32_t sitting = 0;
    bool begun = false;
    for (const base::Bytes& bytes : pieces) {
        const TrackPiece piece = haptic_bridge::decodeTrackPiece(bytes);
        sitting = piece.begins ? piece.sitting : sitting;
        begun = begun || piece.begins;
        count += begun && piece.sitting == sitting ? piece.ticks.size() : 0;
    }
    return count;
}

void replay(const std::vector<base::Bytes>& pieces, const scene::Scene& scene) {
    TickReplay replay(scene, pieces);
    sand::Replica replica(scene);
    std::string rows;
    replay.feel(replica, rows);
    for (std::uint64_t number = 1; number <= 3; ++number) {
        replica.apply({.epoch = 1, .number = number, .engaged = true, .path = {{2000, 2000, 200}, {3000, 2500, 100}}});
        replay.feel(replica, rows);
    }
    const auto felt = static_cast<std::size_t>(std::count(rows.begin(), rows.end(), '\n'));
    fuzz::require(felt + replay.left() == ticksOf(pieces), "a replay has lost ticks");
}

}  // namespace

SANDWALL_FUZZER(ticks) {
    if (size == 0) {
        return 0;
    }
    static const std::array<scene::Scene, 2> kScenes{samples::flatScene(24, 16), samples::tinScene()};
    const fuzz::Input input = fuzz::Input(data, size).subspan(1);
    fuzz::takeOrRefuse([&] {
        if (data[0] % 3 == 0) {
            takePiece(input);
            return;
        }
        std::vector<base::Bytes> pieces;
        for (const fuzz::Input piece : fuzz::piecesOf(input)) {
            pieces.emplace_back(piece.begin(), piece.end());
        }
        replay(pieces, kScenes.at(data[0] % 3 - 1));
    });
    return 0;
}
