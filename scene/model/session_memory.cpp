// SPDX-License-Identifier: Apache-2.0
#include "scene/model/session_memory.hpp"

#include <fmt/format.h>

#include "base/input_error.hpp"

namespace scene {
namespace {

constexpr std::int64_t kMebibyte = 1 << 20;
constexpr std::int64_t kNumber = sizeof(std::int32_t);  // [byte]

constexpr std::int64_t kSettling = 104;  // [byte] for each cell that sand::grid::settle() computes

std::int64_t cellsOf(const sand::FieldSize& field) { return std::int64_t{field.columns} * field.rows; }

/// Returns the memory of numbers that are kept for an undo or a checkpoint, one for each cell. They are packed
/// (sand/grid/packed_cells.hpp), but numbers of all sizes take 32 bits each, and a list.
std::int64_t bytesOfKept(std::int64_t cells) { return cells * 17 / 4; }

}  // namespace

// Memory of a process whose sand is small [byte]. Measured with scripts/figures/sessions/memory_figures.py. The shared
// part is code of programs and libraries.
struct ProcessMemory::Fixed {
    std::int64_t own, shared;
    std::int64_t start = 0;  // more at the start: a rank compiles shaders
};
constexpr ProcessMemory::Fixed kServer{8 * kMebibyte, 10 * kMebibyte};
constexpr ProcessMemory::Fixed kMaster{16 * kMebibyte, 18 * kMebibyte};
constexpr ProcessMemory::Fixed kRank{44 * kMebibyte, 24 * kMebibyte, 32 * kMebibyte};
constexpr std::int64_t kImport = 32 * kMebibyte;  // GDAL and its libraries, of a process that reads a raster

MemoryFigures& MemoryFigures::operator+=(const MemoryFigures& more) {
    rest += more.rest;
    peak += more.peak;
    moving += more.moving;
    return *this;
}

std::int64_t bytesOfPlane(const sand::FieldSize& field) {
    constexpr std::int64_t kPadding = 16;  // [cell], as CellArray's
    const std::int64_t stride = 2 * kPadding + (field.columns + kPadding - 1) / kPadding * kPadding;
    return kNumber * stride * (std::int64_t{field.rows} + 2);
}

std::int64_t bytesOfPackedPlane(const sand::FieldSize& field) {
    // zstd stores blocks of 128 KiB that it cannot compress, with three bytes each.
    return kNumber * cellsOf(field) + cellsOf(field) / 1024 + 4096;
}

SandSize SandSize::of(const sand::Start& start) {
    SandSize size{sand::FieldSize::of(start.rules), start.ground != nullptr};
    (size.field.bytesOfReplica() ? size.toolBytes : size.meshBytes) =
        start.leastBytes() - size.field.bytesOfReplica().value_or(0);
    return size;
}

bool SandSize::hasHeights() const { return field.bytesOfReplica().has_value(); }

ProcessMemory::ProcessMemory(const SandSize& sand, const Fixed& fixed, bool readsRaster)
    : shared_(fixed.shared + (readsRaster ? kImport : 0)) {
    const std::int64_t later = fixed.own + shared_, start = later + fixed.start;
    add("program and libraries", {start, start, later, later, later, start});
    addReplica(sand);
}

void ProcessMemory::addReplica(const SandSize& sand) {
    if (!sand.hasHeights()) {
        add("triangles", {0, sand.meshBytes, sand.meshBytes, sand.meshBytes, sand.meshBytes});
        return;
    }
    const std::int64_t plane = bytesOfPlane(sand.field), packed = bytesOfPackedPlane(sand.field);
    const std::int64_t cells = cellsOf(sand.field);
    add("heights", {0, plane, plane, plane, plane});
    // Reading them takes no memory. Blocks at rest give theirs back after some steps.
    add("fluxes", {0, 0, 2 * plane, 0, 2 * plane});
    add("heights of the start, compressed", {0, packed, packed, packed, packed});
    // The heights before the stroke, by tiles. All tiles are kept if the stroke began before the first sweep, or if all
    // sand has moved since. The fluxes before the stroke are kept if sand moved when it began.
    const std::int64_t before = bytesOfKept(cells);
    add("sand for an undo", {0, 0, before, before, 3 * before});
    // Per block of 8 x 8 cells: marks, and runs of blocks. Per tile of 32 x 32 cells: hash and last movement.
    const std::int64_t marks = cells / 16, runs = cells / 4;
    add("marks of blocks and hashes", {0, marks, runs, marks, runs});
    const std::int64_t ground = sand.ground ? plane : 0;
    add("rock and walls", {0, ground, ground, ground, ground});
    add("coarse phase of the tool", {0, 0, 0, 0, sand.toolBytes});
}

void ProcessMemory::addTerrain(const SandSize& sand) {
    const std::int64_t plane = bytesOfPlane(sand.field), ground = sand.ground ? plane : 0;
    add("raster", {sand.rasterBytes, 0, 0, 0, 0});
    add("heights of the scene", {plane + ground, plane, 0, 0, 0, plane + ground});
    if (sand.settles && sand.hasHeights()) {
        // A replica of its own. Sand with rock or walls settles by sweeps, other sand on several grids of 64-bit
        // floats.
        const std::int64_t cells = cellsOf(sand.field), marks = cells / 16, runs = cells / 4;
        const std::int64_t replica = plane + bytesOfPackedPlane(sand.field) + marks;
        add("settling of the scene", {0, 0, 0, 0, 0, replica + (sand.ground ? 2 * plane + runs : kSettling * cells)});
    }
}

ProcessMemory ProcessMemory::ofServer(const SandSize& sand) {
    ProcessMemory memory(sand, kServer, sand.rasterBytes > 0);
    const std::int64_t plane = bytesOfPlane(sand.field), packed = bytesOfPackedPlane(sand.field);
    memory.addTerrain(sand);
    if (sand.hasHeights()) {
        // A hand whose rest follows the surface has a copy of the heights of the start.
        memory.add("datum of the hand", {0, plane, plane, plane, plane});
        memory.add("compressing the start", {0, packed, 0, 0, 0});
    }
    return memory;
}

ProcessMemory ProcessMemory::ofMaster(const SandSize& sand, bool checkpoints) {
    ProcessMemory memory(sand, kMaster, sand.rasterBytes > 0);
    const std::int64_t packed = bytesOfPackedPlane(sand.field);
    memory.addTerrain(sand);
    if (sand.hasHeights()) {
        // The message for the ranks, and the header of the journal, which grows while it is encoded.
        memory.add("message and journal's header", {0, 4 * packed, 0, 0, 0});
    }
    if (sand.hasHeights() && checkpoints) {
        // The copy shares what the undo keeps. A thread compresses it into the file, a stripe at a time.
        const std::int64_t cells = cellsOf(sand.field);
        memory.add("copy for a checkpoint", {0, 0, 0, 0, 3 * bytesOfKept(cells)});
        memory.add("heap after a checkpoint", {0, 0, 0, cells, 0});
    }
    return memory;
}

ProcessMemory ProcessMemory::ofRank(const SandSize& sand, std::int64_t frameBufferBytes) {
    ProcessMemory memory(sand, kRank, false);
    const std::int64_t plane = bytesOfPlane(sand.field), packed = bytesOfPackedPlane(sand.field);
    const std::int64_t cells = cellsOf(sand.field);
    const std::int64_t frames = frameBufferBytes;
    memory.add("frame buffers", {0, frames, frames, frames, frames});
    if (!sand.hasHeights()) {
        // A height for each nominal cell, from which follows how much sky each place sees.
        const std::int64_t heights = kNumber * cells;
        memory.add("drawn heights", {0, heights, heights, heights, heights});
        return memory;
    }
    memory.add("message of the scene", {2 * packed, packed, 0, 0, 0});
    memory.add("heights of the scene", {0, plane, 0, 0, 0});
    // Heights, their ranges in blocks of 8 x 8 cells, and the chunks.
    const std::int64_t drawn = kNumber * cells + cells / 2 + (sand.ground ? cells : 0);
    memory.add("drawn heights", {0, drawn, drawn, drawn, drawn});
    // A vertex takes 16 bytes, and chunks of 32 x 32 quads share edges. Rough sand that is seen has a vertex for each
    // cell, but at most four for a pixel with the usual `detail` of half a pixel (LevelRule::finest). Sand that moves
    // has at most one for four pixels. A pixel takes 12 bytes of frame buffers or more.
    const std::int64_t pixels = frames / 12, seen = std::min(cells, 4 * pixels), moving = std::min(cells, pixels);
    memory.add("vertices", {0, 0, 17 * seen, 17 * seen, 17 * moving});
    // Places of changes, and triangles that the driver holds.
    const std::int64_t places = cells / 2;
    memory.add("work of drawing", {0, 0, places + 8 * seen, places + 2 * seen, places + 8 * moving});
    return memory;
}

std::int64_t ProcessMemory::bytes(MemoryStage stage) const {
    std::int64_t sum = 0;
    for (const MemoryPart& part : parts_) {
        sum += part.bytes.at(static_cast<std::size_t>(stage));
    }
    return sum;
}

MemoryFigures ProcessMemory::figures() const {
    return {bytes(MemoryStage::rest),
            std::max({bytes(MemoryStage::read), bytes(MemoryStage::settled), bytes(MemoryStage::made),
                      bytes(MemoryStage::swept)}),
            bytes(MemoryStage::moving)};
}

void requireProcess(std::int64_t needed, std::int64_t freeBytes, const std::string& file, const sand::SizeText& size,
                    std::string_view process) {
    if (needed > freeBytes) {
        throw base::InputError(
            fmt::format("{}: {} need {} in the {}, and {} are free: {}, or a machine with more memory", file, size.what,
                        bytesInWords(needed), process, bytesInWords(freeBytes), size.fewer));
    }
}

std::string bytesInWords(std::int64_t bytes) {
    constexpr double kGibibyte = 1 << 30;
    const auto number = static_cast<double>(bytes);
    return number < kGibibyte ? fmt::format("{:.0f} MiB", number / static_cast<double>(kMebibyte))
                              : fmt::format("{:.1f} GiB", number / kGibibyte);
}

}  // namespace scene
