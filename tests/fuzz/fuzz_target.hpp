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

/// A fuzzer hands bytes to one parser, which takes or refuses them. Returns 0.
using Target = int (*)(const std::uint8_t* data, std::size_t size);

/// Makes a fuzzer known to the program that runs them all (mutate_main.cpp), before its main. Returns false if the name
/// is taken.
bool add(const char* name, Target target);

using Input = std::span<const std::uint8_t>;

inline std::string_view textOf(Input input) { return {reinterpret_cast<const char*>(input.data()), input.size()}; }

/// The two ways in which a parser may refuse. Anything else that is thrown ends the program.
template <class Parse>
void takeOrRefuse(const Parse& parse) {
    try {
        parse();
    } catch (const base::InputError& refused) {
        // A complaint is one line, whatever the input holds.
        if (std::string_view(refused.what()).find('\n') != std::string_view::npos) {
            throw std::logic_error("a complaint of more than one line: " + std::string(refused.what()));
        }
    } catch (const base::FormatError&) {
    }
}

/// A file that lives in memory, for parsers that open theirs.
class MemoryFile {
public:
    explicit MemoryFile(Input bytes) : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)) {
        if (descriptor_ < 0 || write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
            throw std::runtime_error("no memory file");
        }
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

/// Cuts an input into pieces, whose lengths it says itself: each begins with a byte pair.
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

/// Begins the function of a fuzzer, with the parameters of fuzz::Target.
#ifdef SANDWALL_LIBFUZZER
#define SANDWALL_FUZZER(name) extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
#else
#define SANDWALL_FUZZER(name)                                                      \
    static int name##Fuzz(const std::uint8_t* data, std::size_t size);             \
    [[maybe_unused]] static const bool name##Known = fuzz::add(#name, name##Fuzz); \
    static int name##Fuzz(const std::uint8_t* data, std::size_t size)
#endif
