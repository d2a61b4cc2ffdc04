#include "common/datagrams/frame_packets.h"

#include <algorithm>
#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

constexpr const char* passphrase = "a passphrase of this test";

Bytes noise(std::size_t size, unsigned seed = 1) {
    std::mt19937 random(seed);
    Bytes bytes(size);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    return bytes;
}

std::vector<Bytes> packets_of_message(const Bytes& message, std::uint32_t number) {
    std::vector<Bytes> packets;
    cut_message(message, number, [&](std::span<const std::byte> packet) {
        packets.emplace_back(packet.begin(), packet.end());
        return true;
    });
    return packets;
}

TEST(FramePackets, AMessageComesBackAsItsParts) {
    const Bytes head = noise(300, 1), colour = noise(200'000, 2), disparity = noise(1, 3);
    for (const std::size_t size : {0, 1, 1304, 1305, 200'000}) {
        const Bytes part = noise(size, 4);
        const Bytes message = join_parts({head, part, colour, disparity}, passphrase);
        EXPECT_EQ(message.size(),
                  message_bytes_of(head.size() + part.size() + colour.size() + disparity.size()));
        FrameJoiner joiner;
        std::optional<Bytes> joined;
        const std::vector<Bytes> packets = packets_of_message(message, 7);
        EXPECT_EQ(packets.size(), packets_of(message.size()));
        for (const Bytes& packet : packets) {
            EXPECT_FALSE(joined);
            EXPECT_LE(packet.size(), packet_bytes);
            joined = joiner.take(packet);
        }
        ASSERT_TRUE(joined);
        const FrameParts parts = split_message(*joined, passphrase);
        EXPECT_TRUE(std::ranges::equal(parts[0], head));
        EXPECT_TRUE(std::ranges::equal(parts[1], part));
        EXPECT_TRUE(std::ranges::equal(parts[2], colour));
        EXPECT_TRUE(std::ranges::equal(parts[3], disparity));
    }
}

TEST(FramePackets, ASealOfAnotherPassphraseOrContentIsRefused) {
    Bytes message = join_parts({noise(10), noise(20), noise(30), noise(40)}, passphrase);
    EXPECT_NO_THROW(split_message(message, passphrase));
    EXPECT_THAT(thrown_sentence([&] { split_message(message, "a passphrase of another"); }),
                HasSubstr("seal"));
    for (std::size_t i = 0; i < message.size(); ++i) {
        message[i] ^= std::byte{1};
        EXPECT_THROW(split_message(message, passphrase), Error) << i;
        message[i] ^= std::byte{1};
    }
    for (std::size_t size = 0; size < message.size(); ++size)
        EXPECT_THROW(split_message(std::span(message).first(size), passphrase), Error) << size;
}

TEST(FramePackets, AMessageThatLacksAPacketIsGivenUpAndTheNextOneComes) {
    const Bytes first = noise(5000, 1), second = noise(6000, 2);
    FrameJoiner joiner;
    const std::vector<Bytes> packets = packets_of_message(first, 0);
    EXPECT_FALSE(joiner.take(packets.at(0)));
    EXPECT_THAT(thrown_sentence([&] { joiner.take(packets.at(2)); }), HasSubstr("follow"));
    EXPECT_THROW(joiner.take(packets.at(3)), Error);
    std::optional<Bytes> joined;
    for (const Bytes& packet : packets_of_message(second, 1)) joined = joiner.take(packet);
    EXPECT_EQ(joined, second);

    // Its sender stopped in the middle.
    joiner.take(packets.at(0));
    joiner.take(packets.at(1));
    for (const Bytes& packet : packets_of_message(second, 2)) joined = joiner.take(packet);
    EXPECT_EQ(joined, second);
}

TEST(FramePackets, PacketsOfTwoMessagesAreNotMixed) {
    FrameJoiner joiner;
    const auto first = packets_of_message(noise(5000, 1), 0);
    const auto second = packets_of_message(noise(5000, 2), 1);
    joiner.take(first.at(0));
    EXPECT_THROW(joiner.take(second.at(1)), Error);
}

TEST(FramePackets, SendingStopsWhenThePacketIsNotTaken) {
    int sent = 0;
    EXPECT_FALSE(cut_message(noise(5000), 0, [&](auto) { return ++sent < 2; }));
    EXPECT_EQ(sent, 2);
}

TEST(FramePackets, AnyBytesAreRefusedOrJoinedWithinTheLimit) {
    std::mt19937 random(5);
    FrameJoiner joiner;
    for (int i = 0; i < 20'000; ++i) {
        Bytes packet = noise(random() % 1400, static_cast<unsigned>(random()));
        // Small numbers, so that some packets follow each other.
        for (std::size_t k = 0; k < std::min<std::size_t>(packet.size(), 12); ++k)
            packet[k] = k % 4 == 0 ? static_cast<std::byte>(random() % 3) : std::byte{0};
        try {
            if (const auto message = joiner.take(packet)) {
                EXPECT_LE(message->size(), max_datagram_message_bytes + packet_bytes);
            }
        } catch (const Error&) {
        }
    }
}

TEST(FramePackets, AMessageBeyondTheLimitIsRefusedAtItsFirstPacket) {
    Bytes packet = noise(packet_bytes);
    const std::uint32_t head[] = {
        0, 0, static_cast<std::uint32_t>(packets_of(max_datagram_message_bytes)) + 1};
    std::memcpy(packet.data(), head, sizeof head);
    FrameJoiner joiner;
    EXPECT_THROW(joiner.take(packet), Error);
}

}  // namespace
}  // namespace vantage
