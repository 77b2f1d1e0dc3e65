// SPDX-License-Identifier: Apache-2.0
// Writes the corpora of the binary formats, with the encoders of this build: FOLDER/wire, ticks, journal, checkpoint,
// saved, state, steps, tin, head, raster, png, wall, fields.
#include <array>
#include <filesystem>
#include <iostream>
#include <random>

#include "haptic_bridge/hand/arm_presets.hpp"
#include "haptic_bridge/link/protocol.hpp"
#include "haptic_bridge/loop/tick_track.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/saved_sand.hpp"
#include "sand/replica.hpp"
#include "sand/tin/surface.hpp"
#include "scene/model/scene.hpp"
#include "tests/described/faults.hpp"
#include "tests/described/samples.hpp"
#include "tests/described/types.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/tin_scene.hpp"
#include "tracking/dtrack.hpp"
#include "tracking/opentrack.hpp"
#include "walls/wall.hpp"

namespace {

namespace fs = std::filesystem;
using base::Bytes;
using fuzz::Folder;
using fuzz::piece;

sand::Step step(std::uint64_t number) {
    sand::Step step{
        .epoch = 1, .number = number, .engaged = true, .path = {{600, 700, 100}, {700, 650, 50}, {-9, 0, 1 << 20}}};
    step.sweeps = 8;
    return step;
}

void writeWire(Folder folder) {
    using namespace haptic_bridge;
    sand::Step tuned = step(2);
    tuned.edit = sand::Edit::tuned({1000, 1001, 4, {.radius = 512}});
    sand::Step loaded = step(3);
    loaded.edit = sand::Edit::loaded({1, 2, 3});
    const Identity identity{kProtocolVersion, sand::kAlgorithmVersion, 5, "scene"};
    const std::vector<Message> all{Hello{identity, Role::watch, true, true, {1}},
                                   Challenge{identity, {2}},
                                   Proof{{3}},
                                   Welcome{identity, 60, Role::watch, {4}},
                                   CatchUp{false, {step(1), step(2)}},
                                   CatchUp{true, {step(3)}},
                                   Loading{500, {6}},
                                   PositionGreeting{kProtocolVersion, "glove", {5}},
                                   Refusal{RefusalCode::scene, "no"},
                                   StartMessage{1, 2, 3},
                                   Ready{},
                                   NeedState{},
                                   State{{1, 2, 3, 4}},
                                   StepMessage{1, 2, step(1)},
                                   StepMessage{1, 2, tuned},
                                   StepMessage{1, 2, loaded},
                                   TimingTest{1, 20},
                                   Shown{7, 16000000, Held::pause},
                                   TimingEcho{1},
                                   Ping{5},
                                   Pong{5, 6},
                                   Report{},
                                   Bye{"enough"},
                                   EditRequest{samples::withNumber(1, sand::Edit::undo)}};
    Bytes stream;
    for (const Message& message : all) {
        const Bytes one = encode(message);
        folder.add(one, {3});
        stream.insert(stream.end(), one.begin(), one.end());
    }
    folder.add(stream, {3 + 4 * 16});
}

/// Writes pieces of the tick track: each alone, and two links after each other. One hand has an arm.
void writeTicks(Folder folder) {
    haptic_bridge::TrackPiece arm{.sitting = 1, .begins = true, .header = {}, .ticks = {}};
    arm.header.body = true;
    arm.header.physics = haptic_bridge::touchPreset();
    arm.header.scale = 100;
    haptic_bridge::TrackPiece felt{.sitting = 1, .begins = false, .header = {}, .ticks = {}};
    for (int i = 0; i < 20; ++i) {
        haptic_bridge::TickInput& tick = felt.ticks.emplace_back();
        tick.time = 1e-3 * i;
        tick.pose = {.x = 0.02 * i - 0.2, .y = 0.1, .z = 0.5, .engaged = i % 7 != 6};
        tick.reading = {.place = {0.001 * i, 0.01, -0.01}, .first = true, .second = false, .present = i % 9 != 8};
        tick.nowNs = 1'000'003 * static_cast<std::int64_t>(i);
        tick.surfaceAgeNs = 5'000'000;
        tick.surfaceStep = static_cast<std::uint64_t>(i) / 6;
        tick.surfaceProbe = {2000 + 300 * (i / 10), 2000, 0};
    }
    haptic_bridge::TrackPiece recorded{.sitting = 2, .begins = true, .header = {}, .ticks = {}};
    haptic_bridge::TrackPiece last = felt;
    last.sitting = 2;
    base::ByteWriter track;
    for (const auto& part : {arm, felt, recorded, last}) {
        folder.add(encode(part), {0});
        track.putBytes(piece(encode(part)));
    }
    for (const std::uint8_t kind : {std::uint8_t{1}, std::uint8_t{2}}) {
        folder.add(track.bytes(), {kind});
    }
}

void writeJournal(Folder folder, const fs::path& scratch) {
    const scene::Scene scene = samples::flatScene(8, 8);
    {
        master::JournalWriter journal(scratch, scene, "build");
        journal.append({1, 17, {step(1), step(2)}});
        journal.keep(scene::Material());
        journal.append({2, 18, {step(3)}});
        journal.finish(3, 19);
        journal.resume({2, {3, 19}, 7, "a kill"});
    }
    folder.add(fuzz::bytesOf(scratch), {1});
    fs::remove(scratch);
    // Two records of a journal without their checksums.
    base::ByteWriter frame;
    frame.put(std::uint8_t{1});
    frame.putVarint(1);
    frame.put(std::uint64_t{17});
    frame.putVarint(2);
    step(1).put(frame);
    step(2).put(frame);
    base::ByteWriter end;
    end.put(std::uint8_t{2});
    end.put(std::uint64_t{2});
    end.put(std::uint64_t{19});
    Bytes records = piece(frame.take());
    const Bytes last = piece(end.take());
    records.insert(records.end(), last.begin(), last.end());
    folder.add(records, {0});
}

void writeCheckpoints(Folder folder) {
    sand::Replica replica(samples::flatScene(24, 16));
    for (std::uint64_t number = 1; number <= 3; ++number) {
        replica.apply(step(number));
        const master::Checkpoint checkpoint{1,      "build", replica.rules().digest(), number,
                                            number, 1,       replica.stateHash(),      replica.encodeState()};
        const Bytes bytes = checkpoint.encode();
        folder.add(bytes, {0});
        folder.add(Bytes(bytes.begin(), bytes.end() - 8), {1});  // without its checksum
    }
}

/// Writes files of saved sand, whole and without their checksum.
void writeSaved(Folder folder, const fs::path& scratch) {
    const std::array<scene::Scene, 2> scenes{samples::flatScene(24, 16), samples::tinScene()};
    for (std::size_t kind = 0; kind < scenes.size(); ++kind) {
        sand::Replica replica(scenes[kind]);
        replica.apply(step(1));
        master::writeSavedSand(scratch, {master::SandPlace::of(scenes[kind]), replica.stepNumber(), replica.stateHash(),
                                         replica.copySand()->encode()});
        const Bytes bytes = fuzz::bytesOf(scratch);
        folder.add(bytes, {static_cast<std::uint8_t>(2 * kind)});
        folder.add(Bytes(bytes.begin(), bytes.end() - 8), {static_cast<std::uint8_t>(2 * kind + 1)});
    }
    fs::remove(scratch);
}

/// Returns the plain bytes of sand, as fuzz::packedSand() reads them.
Bytes plainOf(const sand::Replica& replica) {
    base::ByteWriter plain;
    if (const auto* tin = dynamic_cast<const sand::tin::TinSurface*>(&replica.surface()); tin != nullptr) {
        dynamic_cast<const sand::tin::Snapshot&>(*tin->copy()).state().encode(plain);
        tin->layer().encode(plain);
        return plain.take();
    }
    plain.put(replica.outflow());
    const sand::HeightField& field = std::get<sand::GridData>(replica.surface().data()).field;
    for (int y = 0; y < field.rows(); ++y) {
        for (int x = 0; x < field.columns(); ++x) {
            plain.put(field.height(x, y));
        }
    }
    plain.put(std::int32_t{3});
    plain.put(std::uint8_t{0});
    return plain.take();
}

/// Returns the plain bytes of a state, as fuzz::packedState() reads them. The sand of `before` is kept for an undo.
Bytes plainStateOf(const sand::Replica& replica, const sand::Replica& before) {
    base::ByteWriter plain;
    plain.putBytes(piece(replica.copyState().head));
    plain.putBytes(piece(replica.copyState().movement));
    plain.putBytes(piece(plainOf(before)));
    plain.putBytes(plainOf(replica));
    return plain.take();
}

void writeState(Folder folder) {
    const scene::Scene scene = samples::flatScene(24, 16);
    sand::Replica replica(scene);
    for (std::uint64_t number = 1; number <= 3; ++number) {
        replica.apply(step(number));
    }
    folder.add(replica.encodeState(), {0});
    folder.add(replica.copySand()->encode(), {1});
    folder.add(scene.encode(), {2});
    folder.add(replica.copySand()->encode(), {3});
    folder.add(plainStateOf(replica, sand::Replica(scene)), {4});
    folder.add(plainOf(replica), {5});
    folder.add(plainOf(replica), {7});
}

/// Writes inputs of the fuzzer of steps: a kind of scene, a state, and steps with every edit.
void writeSteps(Folder folder) {
    std::array<scene::Scene, 5> scenes{samples::flatScene(24, 16), samples::flatScene(24, 16),
                                       samples::flatScene(24, 16), samples::tinScene(), samples::tinScene()};
    for (std::size_t kind = 0; kind < scenes.size(); ++kind) {
        sand::Replica replica(scenes[kind]);
        const sand::Replica before = replica;
        replica.apply({.epoch = 1, .number = 1, .engaged = true, .path = {{2000, 2000, 200}, {3000, 2500, 100}}});
        base::ByteWriter input;
        input.putBytes(piece(plainStateOf(replica, before)));
        sand::Edit tuned = sand::Edit::tuned(scenes[kind].rules.tuning);
        tuned.tuning.tool.kind = sand::ToolKind::rectangle;
        tuned.tuning.tool.halfWidth = tuned.tuning.tool.radius / 2;
        for (const sand::Edit& edit :
             {sand::Edit(), sand::Edit(sand::Edit::settle), tuned, sand::Edit(sand::Edit::undo),
              sand::Edit::loaded(plainOf(before)), sand::Edit(sand::Edit::reset)}) {
            sand::Step next = step(1);
            next.edit = edit;
            base::ByteWriter bytes;
            next.put(bytes);
            input.putBytes(piece(bytes.take()));
        }
        folder.add(input.take(), {static_cast<std::uint8_t>(kind)});
    }
}

void writeTin(Folder folder) {
    const scene::Scene scene = samples::tinScene();
    sand::tin::TinSurface surface(scene.rules, scene.tin);
    const sand::Tool& tool = scene.rules.tuning.tool;
    const auto add = [&] {
        folder.add(surface.copy()->encode(), {1});
        base::ByteWriter plain;
        dynamic_cast<const sand::tin::Snapshot&>(*surface.copy()).state().encode(plain);
        surface.layer().encode(plain);
        folder.add(plain.take(), {0});
    };
    add();
    surface.drag(tool, std::array{sand::ProbePoint{1000, 1000, 200}, sand::ProbePoint{2000, 1500, 100}});
    add();  // with an imprint of the tool
    surface.leave(tool);
    surface.sweep(sand::SweepPart::all(8), nullptr, {});
    add();
    base::ByteWriter start;
    scene.tin->encode(start);
    folder.add(start.take(), {2});
    sand::Ground walls(6, 6);  // two wall cells that touch at a corner
    walls.setWall(2, 2);
    walls.setWall(3, 3);
    sand::tin::follow(sand::HeightField(6, 6, 1), &walls, {.maxError = 1000}).start.encode(start);
    folder.add(start.take(), {2});
    sand::Replica whole(scene);
    const sand::Replica before = whole;
    whole.apply({.epoch = 1, .number = 1, .engaged = true, .path = {{1000, 1000, 200}, {2000, 1500, 100}}});
    folder.add(plainStateOf(whole, before), {3});
}

void writeHead(Folder folder) {
    const tracking::Pose pose{{0.1, 1.7, 2}, {1, 0, 0}};
    folder.add(piece(tracking::opentrackPacket(pose)), {0});
    Bytes packets = piece(tracking::dtrackPacket(pose, 7, 1));
    const Bytes next = piece(tracking::dtrackPacket(pose, 8, 1));
    packets.insert(packets.end(), next.begin(), next.end());
    folder.add(packets, {1});
    const std::string trace = "time,x,y,z\n0,0.1,1.7,2\n0.5,0.2,1.7,2\n";
    folder.add(Bytes(trace.begin(), trace.end()), {2});
}

/// Writes samples of every described type, behind its number in described::Types.
void writeFields(Folder folder) {
    std::mt19937 random;
    std::uint8_t number = 0;
    described::forEachType<described::Types>([&]<class T>() {
        for (const Bytes& sample : described::samplesOf<T>(random)) {
            folder.add(sample, {number});
        }
        ++number;
    });
}

}  // namespace

int main(int count, char** words) {
    if (count != 2) {
        std::cerr << "usage: " << words[0] << " FOLDER\n";
        return 2;
    }
    const fs::path folder = words[1];
    writeWire({folder, "wire"});
    writeTicks({folder, "ticks"});
    writeJournal({folder, "journal"}, folder / "scratch.journal");
    writeCheckpoints({folder, "checkpoint"});
    writeSaved({folder, "saved"}, folder / "scratch.sand");
    writeState({folder, "state"});
    writeSteps({folder, "steps"});
    writeTin({folder, "tin"});
    writeHead({folder, "head"});
    fuzz::writeRasters({folder, "raster"});
    fuzz::writePngs({folder, "png"});
    writeFields({folder, "fields"});
    Folder walls(folder, "wall");
    for (const auto& file : fs::directory_iterator(SANDWALL_SOURCE_DIR "/walls/configs")) {
        if (file.is_regular_file()) {
            walls.add(walls::loadWall(file.path()).encode());
        }
    }
}
