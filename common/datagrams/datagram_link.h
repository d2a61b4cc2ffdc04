#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/config/socket_address.h"
#include "common/datagrams/frame_packets.h"
#include "common/wire/link_message.h"
#include "common/wire/wake_event.h"

namespace vantage {

/// The host's end of a road of datagrams: connects to the rig over SRT as it was offered, and
/// receives its frames on a thread of its own until the road ends.
class DatagramLink {
  public:
    /// Returns at once. `arrived` is notified when a message or the road's end waits.
    DatagramLink(const SocketAddress& rig, const DatagramOffer& offer, const WakeEvent& arrived);
    ~DatagramLink();
    DatagramLink(const DatagramLink&) = delete;
    DatagramLink& operator=(const DatagramLink&) = delete;

    /// The next whole message, for split_message() with the offer's passphrase; empty if none
    /// waits. A bounded number waits, and further ones wait in SRT's buffer.
    std::optional<std::vector<std::byte>> next();

    struct State {
        bool is_open = false;
        std::string trouble;        ///< why it did not open or ended, in a sentence; empty: it did
        std::uint64_t damaged = 0;  ///< datagrams that are not part of a frame
        std::string last_fault;     ///< of the last of them
    };
    State state() const;
    const DatagramOffer& offer() const { return offer_; }

  private:
    void run();
    void connect();
    void read();
    void take(std::span<const std::byte> packet);
    bool is_full() const;

    const SocketAddress rig_;
    const DatagramOffer offer_;
    const WakeEvent& arrived_;
    int socket_ = -1;
    FrameJoiner joiner_;
    mutable std::mutex mutex_;  ///< guards messages_ and state_
    std::deque<std::vector<std::byte>> messages_;
    State state_;
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
