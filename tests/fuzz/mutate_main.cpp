// SPDX-License-Identifier: Apache-2.0
// Runs a fuzzer without libFuzzer. Tries every file of a corpus, then a number of changed inputs. These are the same in
// every run, unless SANDWALL_SEED gives another seed. An input that ends the program stays in the file crash-input.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz_target.hpp"

namespace {

using base::Bytes;

class Mutator {
public:
    Mutator(std::vector<Bytes> corpus, std::uint64_t seed) : corpus_(std::move(corpus)), random_(seed) {}

    Bytes next() {
        Bytes bytes = corpus_[below(corpus_.size())];
        for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
            change(bytes);
        }
        return bytes;
    }

private:
    std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

    void change(Bytes& bytes) {
        const std::size_t at = below(bytes.size() + 1);
        const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        const std::size_t length = std::min(1 + below(1U << below(8)), bytes.size() - at);
        switch (below(6)) {
            case 0:  // a flipped bit
                if (at < bytes.size()) {
                    bytes[at] ^= static_cast<std::uint8_t>(1U << below(8));
                }
                break;
            case 1:  // some bytes left out
                bytes.erase(place, place + static_cast<std::ptrdiff_t>(length));
                break;
            case 2: {  // some bytes repeated
                const Bytes twice(place, place + static_cast<std::ptrdiff_t>(length));
                bytes.insert(place, twice.begin(), twice.end());
                break;
            }
            case 3:  // cut short
                bytes.resize(at);
                break;
            case 4: {  // a very large or very odd number
                constexpr std::array<std::uint64_t, 6> kOdd{
                    0, ~0ULL, 0x7fffffffffffffffULL, 0x80000000ULL, 0x7ff8000000000000ULL, 1ULL << 28U};
                const std::uint64_t odd = kOdd[below(kOdd.size())];
                for (std::size_t i = 0; i < std::min<std::size_t>(8, bytes.size() - at); ++i) {
                    bytes[at + i] = static_cast<std::uint8_t>(odd >> (8 * i));
                }
                break;
            }
            default: {  // the end of another input
                const Bytes& other = corpus_[below(corpus_.size())];
                bytes.resize(at);
                const auto from = static_cast<std::ptrdiff_t>(below(other.size() + 1));
                bytes.insert(bytes.end(), other.begin() + from, other.end());
            }
        }
    }

    std::vector<Bytes> corpus_;
    std::mt19937_64 random_;
};

std::vector<Bytes> corpusOf(const std::vector<std::filesystem::path>& folders) {
    std::vector<std::filesystem::path> found;
    for (const auto& folder : folders) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.is_regular_file()) {
                found.push_back(entry.path());
            }
        }
    }
    std::sort(found.begin(), found.end());  // folders list their files in any order
    std::vector<Bytes> corpus;
    for (const auto& file : found) {
        std::ifstream stream(file, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    }
    return corpus;
}

constexpr const char* kCrashInput = "crash-input";

/// Writes each input to a file before it is tried, so that the file shows the input that ended the program.
class Runner {
public:
    explicit Runner(fuzz::Target target)
        : target_(target), kept_(open(kCrashInput, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {}
    ~Runner() {
        close(kept_);
        std::filesystem::remove(kCrashInput);
    }
    Runner(const Runner&) = delete;
    Runner& operator=(const Runner&) = delete;

    void run(const Bytes& input) const {
        if (pwrite(kept_, input.data(), input.size(), 0) != static_cast<ssize_t>(input.size()) ||
            ftruncate(kept_, static_cast<off_t>(input.size())) != 0) {
            throw std::runtime_error("cannot write the input to the file crash-input");
        }
        target_(input.data(), input.size());
    }

private:
    fuzz::Target target_;
    int kept_;
};

std::map<std::string, fuzz::Target>& targets() {
    static std::map<std::string, fuzz::Target> all;  // filled before main, in any order of the sources
    return all;
}

constexpr std::uint64_t kSeed = 20261122;

}  // namespace

bool fuzz::add(const char* name, Target target) { return targets().emplace(name, target).second; }

int main(int count, char** words) {
    const auto target = count < 2 ? targets().end() : targets().find(words[1]);
    if (count < 4 || target == targets().end()) {
        fmt::print(stderr, "usage: {} NAME CHANGES FOLDER...; NAME is one of", words[0]);
        for (const auto& known : targets()) {
            fmt::print(stderr, " {}", known.first);
        }
        fmt::print(stderr, "\n");
        return 2;
    }
    const long changes = std::strtol(words[2], nullptr, 10);
    const std::vector<Bytes> corpus = corpusOf({words + 3, words + count});
    if (corpus.empty()) {
        fmt::print(stderr, "{}: the corpus is empty\n", words[0]);
        return 1;
    }
    const char* wanted = std::getenv("SANDWALL_SEED");
    const std::uint64_t seed = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : kSeed;
    fmt::print("{} inputs of the corpus, {} changed ones; SANDWALL_SEED={}\n", corpus.size(), changes, seed);
    std::fflush(stdout);
    const Runner runner(target->second);
    for (const Bytes& input : corpus) {
        runner.run(input);
    }
    Mutator mutator(corpus, seed);
    for (long i = 0; i < changes; ++i) {
        runner.run(mutator.next());
    }
    return 0;
}
