// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sand/start.hpp"

/// Memory that each process of a session takes. This is the only place that states it.
///
/// The figures are for sand as rough as can be, whose heights cannot be compressed. Smooth sand takes less. They leave
/// out a `settle` of an operator (docs/limits.md), a state that is sent to a rank or a server during the session, and
/// the strokes and edits that a master can undo (sand::History).
namespace scene {

/// Stages of a process in which its memory differs.
enum class MemoryStage : std::uint8_t {
    read,    // it reads the scene's file
    made,    // it makes its replica, and what it sends or draws
    swept,   // the first sweep visits all cells
    rest,    // all sand is at rest, and a stroke is kept for an undo
    moving,  // all sand moves, and has since a stroke that is kept; the master writes a checkpoint
    settled  // between `read` and `made`: the sand of the scene's file comes to rest, if the file has `settle`
};
inline constexpr std::size_t kMemoryStages = 6;

/// Memory at the points of a session that are printed [byte].
struct MemoryFigures {
    std::int64_t rest = 0;
    std::int64_t peak = 0;  // largest before the sand is at rest for the first time
    std::int64_t moving = 0;

    /// Returns the memory that must be free before the process starts.
    [[nodiscard]] std::int64_t most() const { return std::max({rest, peak, moving}); }
    MemoryFigures& operator+=(const MemoryFigures& more);
    friend bool operator==(const MemoryFigures&, const MemoryFigures&) = default;
};

/// One kind of data of a process, with its bytes in each stage.
struct MemoryPart {
    std::string_view name;
    std::array<std::int64_t, kMemoryStages> bytes{};  // [byte], by MemoryStage
};

/// Size of the sand of a session, as far as memory depends on it.
struct SandSize {
    sand::FieldSize field;
    bool ground = false;           // whether it has rock or wall cells
    std::int64_t rasterBytes = 0;  // memory of the pixels while a raster is read [byte]
    std::int64_t toolBytes = 0;    // of a coarse phase [byte]
    std::int64_t meshBytes = 0;    // of triangles; 0 for a height field, and before the triangles are made
    bool settles = false;          // whether the scene's file has `settle`, which server and master do

    /// Returns the size of the sand that `start` has.
    [[nodiscard]] static SandSize of(const sand::Start& start);
    /// Returns whether the sand has a height for each cell, and not triangles.
    [[nodiscard]] bool hasHeights() const;
};

/// Memory of one process.
class ProcessMemory {
public:
    struct Fixed;  // memory without sand

    [[nodiscard]] static ProcessMemory ofServer(const SandSize& sand);
    /// Without `checkpoints`, the session writes none.
    [[nodiscard]] static ProcessMemory ofMaster(const SandSize& sand, bool checkpoints = true);
    [[nodiscard]] static ProcessMemory ofRank(const SandSize& sand, std::int64_t frameBufferBytes);

    [[nodiscard]] const std::vector<MemoryPart>& parts() const { return parts_; }
    [[nodiscard]] std::int64_t bytes(MemoryStage stage) const;
    [[nodiscard]] MemoryFigures figures() const;
    /// Returns the part of every figure that processes of the same kind on one host share, because it is code [byte].
    [[nodiscard]] std::int64_t shared() const { return shared_; }

private:
    ProcessMemory(const SandSize& sand, const Fixed& fixed, bool readsRaster);
    void add(std::string_view name, const std::array<std::int64_t, kMemoryStages>& bytes) {
        parts_.push_back({name, bytes});
    }
    void addReplica(const SandSize& sand);
    /// Adds what a process that reads the scene's file holds until its replica exists, also while its sand settles.
    void addTerrain(const SandSize& sand);

    std::vector<MemoryPart> parts_;
    std::int64_t shared_;
};

/// Returns the memory of one number for each cell, as sand::CellArray holds it [byte].
[[nodiscard]] std::int64_t bytesOfPlane(const sand::FieldSize& field);
/// Returns the most bytes that one number for each cell takes when it is compressed.
[[nodiscard]] std::int64_t bytesOfPackedPlane(const sand::FieldSize& field);

/// Throws base::InputError unless `needed` bytes fit into `freeBytes`. The message is "FILE: WHAT need 4.0 GiB in the
/// PROCESS, and 1.0 GiB are free: ADVICE, or a machine with more memory".
void requireProcess(std::int64_t needed, std::int64_t freeBytes, const std::string& file, const sand::SizeText& size,
                    std::string_view process);

/// Returns a number of bytes for a person, such as "3.2 GiB" or "180 MiB".
[[nodiscard]] std::string bytesInWords(std::int64_t bytes);

}  // namespace scene
