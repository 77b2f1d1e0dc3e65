// SPDX-License-Identifier: Apache-2.0
// The bytes behind the last whole record of a journal. They can be a torn write, damage in front of a later write, or
// bytes that were made to look like records. The work is counted in bytes that are hashed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "tests/journal/journal_in_memory.hpp"

namespace {

constexpr std::uint64_t kOffset = 1000;  // [byte], place of the tail in its part
constexpr std::size_t kHead = sizeof(std::uint32_t) + 1 + sizeof(std::uint64_t);

template <class T>
void put(base::Bytes& bytes, std::size_t at, T value) {
    std::memcpy(&bytes[at], &value, sizeof value);
}

/// Makes the head of a record, which begins a write, at `at`. Its body ends at `end`. The mark is that of another
/// place.
void putHead(base::Bytes& tail, std::size_t at, std::size_t end) {
    put(tail, at, static_cast<std::uint32_t>(end - at - journal::kAroundPayload));
    put(tail, at + sizeof(std::uint32_t), std::uint8_t{0x81});
    put(tail, at + sizeof(std::uint32_t) + 1, std::uint64_t{3});
}

/// Returns `size` bytes full of heads, one in each `every` bytes. `endOf` returns where the record of a head ends.
template <class EndOf>
base::Bytes headsOf(std::size_t size, std::size_t every, EndOf endOf) {
    base::Bytes tail(size);
    for (std::size_t at = 8; at + kHead + sizeof(std::uint64_t) <= size; at += every) {
        putHead(tail, at, std::min(size, std::max(endOf(at), at + kHead + sizeof(std::uint64_t))));
    }
    return tail;
}

/// Returns a record that begins a write at byte `synced` of its part, behind the checksum `chain`.
base::Bytes writeAt(std::uint64_t synced, std::uint64_t chain) {
    return journal::encodeRecord(journal::JournalEnd{7, 8}, chain, synced);
}

void append(base::Bytes& to, const base::Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

/// Appends a whole write that was at another place before. The checksum of the record before it is still there.
void appendMoved(base::Bytes& tail) {
    constexpr std::uint64_t kChain = 0x123456789abcdef0;
    tail.resize(tail.size() + sizeof kChain);
    put(tail, tail.size() - sizeof kChain, kChain);
    append(tail, writeAt(kOffset + 17, kChain));
}

void expectBound(const base::Bytes& tail, const char* what) {
    const journal::LaterWrite search = journal::searchLaterWrite(tail, kOffset);
    EXPECT_FALSE(search.found) << what;
    EXPECT_LE(search.hashed, journal::kMostHashesOfTail * tail.size()) << what;
    EXPECT_GT(search.hashed, 0U) << what << ": has no head that looks like one of a record";
}

// Without the bound, the heads of the first line hash half of the square of the length.
TEST(Tail, IsHashedAFewTimesHoweverManyRecordsItSeemsToHold) {
    for (const std::size_t size : {std::size_t{1} << 12, std::size_t{1} << 16, std::size_t{4} << 20}) {
        SCOPED_TRACE(size);
        expectBound(headsOf(size, kHead, [&](std::size_t) { return size; }), "each record is exactly the rest");
        expectBound(headsOf(size, 1 + kHead, [&](std::size_t at) { return size - at / 2; }), "records within records");
        expectBound(headsOf(size, kHead + 8, [&](std::size_t at) { return at; }), "many tiny records");
        expectBound(headsOf(size, kHead, [&](std::size_t at) { return at + size / 16; }), "records that overlap");
    }
}

TEST(Tail, OfMadeUpRecordsIsReadAsATornWrite) {
    test::JournalInMemory journal(samples::flatScene(8, 8));
    journal.add(journal::JournalEnd{});
    const base::Bytes tail = headsOf(std::size_t{4} << 20, kHead, [](std::size_t) { return std::size_t{4} << 20; });
    append(journal.parts()[0], tail);
    journal::JournalReader reader = journal.reader();
    while (reader.next()) {
    }
    EXPECT_EQ(reader.tornBytes(), static_cast<std::int64_t>(tail.size()));
}

TEST(Tail, HoldsALaterWriteFarBehindATornOne) {
    std::mt19937 random(5);
    base::Bytes torn(std::size_t{1} << 20);
    std::generate(torn.begin(), torn.end(), [&] { return static_cast<std::uint8_t>(random()); });
    base::Bytes moved = torn;
    appendMoved(moved);
    EXPECT_TRUE(journal::searchLaterWrite(moved, kOffset).found);
    base::Bytes inPlace = torn;
    append(inPlace, writeAt(kOffset + torn.size(), 0));
    EXPECT_TRUE(journal::searchLaterWrite(inPlace, kOffset).found);
    EXPECT_FALSE(journal::searchLaterWrite(torn, kOffset).found);
}

// Three records may be as long as the rest. A fourth one uses up nothing, because it is not hashed.
TEST(Tail, ALaterWriteIsFoundAsLongAsTheBoundAllowsAndAtItsPlaceAlways) {
    constexpr std::size_t kSize = 1 << 16;
    for (int heads = 1; heads <= 4; ++heads) {
        SCOPED_TRACE(heads);
        base::Bytes tail(kSize);
        appendMoved(tail);
        for (int head = 0; head < heads; ++head) {
            putHead(tail, 8 + kHead * static_cast<std::size_t>(head), tail.size());
        }
        EXPECT_TRUE(journal::searchLaterWrite(tail, kOffset).found);
    }
    base::Bytes many = headsOf(kSize, kHead, [&](std::size_t) { return kSize; });
    base::Bytes moved = many;
    appendMoved(moved);
    EXPECT_FALSE(journal::searchLaterWrite(moved, kOffset).found) << "the bound has no bytes left for it";
    append(many, writeAt(kOffset + many.size(), 0));
    EXPECT_TRUE(journal::searchLaterWrite(many, kOffset).found) << "a mark at its place needs no hash";
}

}  // namespace
