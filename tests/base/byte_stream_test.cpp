// SPDX-License-Identifier: Apache-2.0
#include "base/byte_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>

namespace {

using base::Bytes;

std::uint64_t read(const Bytes& bytes) { return base::ByteReader(bytes).getVarint(); }

Bytes written(std::uint64_t value) {
    base::ByteWriter writer;
    writer.putVarint(value);
    return writer.take();
}

/// Keeps what a writer passes on.
class Passed final : public base::ByteSink {
public:
    void write(std::span<const std::uint8_t> piece) override {
        bytes.insert(bytes.end(), piece.begin(), piece.end());
        ++pieces;
    }
    void overwrite(std::uint64_t place, std::span<const std::uint8_t> piece) override {
        std::copy(piece.begin(), piece.end(), bytes.begin() + static_cast<std::ptrdiff_t>(place));
    }
    Bytes bytes;
    int pieces = 0;
};

TEST(ByteWriter, PassesTheSameBytesToASink) {
    const auto writeTo = [](base::ByteWriter& writer) {
        const std::uint64_t outer = writer.beginBlock();
        writer.putText("a block that is passed on before its end");
        for (const std::size_t size : {std::size_t{10}, base::ByteWriter::kPiece, base::ByteWriter::kPiece / 3}) {
            const std::uint64_t inner = writer.beginBlock();
            writer.putBytes(Bytes(size, 7));
            writer.endBlock(inner);
            writer.putVarint(size);
        }
        writer.endBlock(outer);
        writer.putBlock({});
    };
    base::ByteWriter whole;
    writeTo(whole);
    Passed passed;
    base::ByteWriter inPieces(passed);
    writeTo(inPieces);
    EXPECT_GT(passed.pieces, 0);
    inPieces.flush();
    EXPECT_TRUE(passed.bytes == whole.bytes());
}

TEST(Varint, OfEveryLengthIsReadAsItWasWritten) {
    EXPECT_EQ(written(0), Bytes{0});
    for (unsigned bits = 0; bits < 64; ++bits) {
        for (const std::uint64_t value : {std::uint64_t{1} << bits, (std::uint64_t{2} << bits) - 1}) {
            const Bytes bytes = written(value);
            EXPECT_EQ(bytes.size(), bits / 7 + 1) << value;
            EXPECT_EQ(read(bytes), value);
        }
    }
}

TEST(Varint, HasOneForm) {
    for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{127}, std::uint64_t{128},
                                      std::uint64_t{1} << 62, std::numeric_limits<std::uint64_t>::max() >> 1}) {
        Bytes bytes = written(value);
        while (bytes.size() < 10) {
            bytes.back() |= 0x80U;
            bytes.push_back(0);
            EXPECT_THROW(read(bytes), base::FormatError) << value << " in " << bytes.size() << " bytes";
        }
    }
}

TEST(Varint, LosesNoBitsAbove64) {
    Bytes bytes = written(std::numeric_limits<std::uint64_t>::max());
    ASSERT_EQ(bytes.size(), 10U);
    ASSERT_EQ(bytes.back(), 1);
    for (const int last : {2, 3, 0x7f}) {
        bytes.back() = static_cast<std::uint8_t>(last);
        EXPECT_THROW(read(bytes), base::FormatError) << last;
    }
    bytes.back() = 0x81;
    bytes.push_back(1);
    EXPECT_THROW(read(bytes), base::FormatError) << "an eleventh byte";
}

TEST(Varint, WithASignHasOneForm) {
    for (const std::int64_t value : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{63}, std::int64_t{-64},
                                     std::numeric_limits<std::int64_t>::min()}) {
        base::ByteWriter writer;
        writer.putSigned(value);
        Bytes bytes = writer.take();
        EXPECT_EQ(base::ByteReader(bytes).getSigned(), value);
        bytes.back() |= 0x80U;
        bytes.push_back(0);
        EXPECT_THROW(base::ByteReader(bytes).getSigned(), base::FormatError) << value;
    }
}

}  // namespace
