// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>

#include "base/byte_stream.hpp"

/// Corpora that this build writes for its fuzzers.
namespace fuzz {

/// Folder with the corpus of one fuzzer.
class Folder {
public:
    Folder(const std::filesystem::path& parent, const std::string& name) : path_(parent / name) {
        std::filesystem::create_directories(path_);
    }

    /// Adds a seed to the corpus. The bytes `before` tell the fuzzer how to read the rest.
    void add(const base::Bytes& seed, std::initializer_list<std::uint8_t> before = {}) {
        base::Bytes all(before);
        all.insert(all.end(), seed.begin(), seed.end());
        std::ofstream(path_ / ("seed" + std::to_string(++count_)), std::ios::binary)
            .write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size()));
    }

private:
    std::filesystem::path path_;
    int count_ = 0;
};

/// Returns bytes with their length before them, as fuzz::piecesOf() cuts an input.
inline base::Bytes piece(const base::Bytes& bytes) {
    base::Bytes all{static_cast<std::uint8_t>(bytes.size() & 255U), static_cast<std::uint8_t>(bytes.size() >> 8U)};
    all.insert(all.end(), bytes.begin(), bytes.end());
    return all;
}

/// Returns the bytes of a file. Returns an empty list if it cannot be read.
inline base::Bytes bytesOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Writes rasters of the formats that the importer accepts, with the files beside them.
void writeRasters(Folder folder);
/// Writes PNG files, whole and as chunks.
void writePngs(Folder folder);

}  // namespace fuzz
