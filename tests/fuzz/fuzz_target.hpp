// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/byte_stream.hpp"
#include "base/input_error.hpp"

namespace fuzz {

/// Passes bytes to one parser, which accepts or refuses them. Returns 0.
using Target = int (*)(const std::uint8_t* data, std::size_t size);

/// Registers a fuzzer with the program that runs all fuzzers (mutate_main.cpp), before its main(). Returns false if the
/// name is already used.
bool add(const char* name, Target target);

using Input = std::span<const std::uint8_t>;

inline std::string_view textOf(Input input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

/// Runs `parse`, which may throw InputError or FormatError to refuse its input. Any other exception ends the program.
template <class Parse>
void takeOrRefuse(const Parse& parse) {
    try {
        parse();
    } catch (const base::InputError& refused) {
        // An error message is one line, whatever the input holds.
        if (std::string_view(refused.what()).find('\n') != std::string_view::npos) {
            throw std::logic_error("an error message has more than one line: " + std::string(refused.what()));
        }
    } catch (const base::FormatError&) {
    }
}

/// Ends the program with `what` unless `good`. For what must be true of an accepted input.
inline void require(bool good, const char* what) {
    if (!good) {
        throw std::logic_error(what);
    }
}

/// A file in memory, for parsers that open their files themselves.
class MemoryFile {
public:
    explicit MemoryFile(Input bytes) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
        if (descriptor_ < 0 || write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
            throw std::runtime_error("cannot make a file in memory");
        }
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

/// Cuts an input into pieces. Each piece begins with its length in two bytes.
inline std::vector<Input> piecesOf(Input input) {
    std::vector<Input> pieces;
    while (input.size() >= 2) {
        const std::size_t wanted = static_cast<std::size_t>(input[0]) | static_cast<std::size_t>(input[1]) << 8U;
        input = input.subspan(2);
        const std::size_t length = wanted < input.size() ? wanted : input.size();
        pieces.push_back(input.first(length));
        input = input.subspan(length);
    }
    return pieces;
}

}  // namespace fuzz

/// Begins the function of a fuzzer. Its parameters are those of fuzz::Target.
#ifdef SANDWALL_LIBFUZZER
#define SANDWALL_FUZZER(name) extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
#else
#define SANDWALL_FUZZER(name)                                                      \
    static int name##Fuzz(const std::uint8_t* data, std::size_t size);             \
    [[maybe_unused]] static const bool name##Known = fuzz::add(#name, name##Fuzz); \
    static int name##Fuzz(const std::uint8_t* data, std::size_t size)
#endif
