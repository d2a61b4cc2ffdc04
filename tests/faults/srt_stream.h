#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace vantage {

/// How frames go over SRT. Every stream is encrypted with AES-128, and lost packets are sent again.
struct SrtManner {
    std::string name;
    /// A frame is one message, under SRT's congestion control for files. Otherwise it is divided
    /// into packets, which are sent at up to `most_bytes_per_s`, whatever is lost.
    bool sends_messages = false;
    /// The receiver holds each packet back until it is this old, and then drops those that are
    /// missing. 0: it returns packets as soon as they are there in order, and drops none.
    int hold_ms = 0;
    /// SRT's packet filter, such as "fec,cols:10,rows:5"; empty: none.
    std::string filter = {};
    std::int64_t most_bytes_per_s = 40'000'000;
};

/// Sends frames over SRT to one receiver. Used by one thread.
class SrtSender {
  public:
    /// Listens at this port of all addresses, on the calling thread's network. Throws Error.
    SrtSender(const SrtManner& manner, int port);
    ~SrtSender();
    SrtSender(const SrtSender&) = delete;
    SrtSender& operator=(const SrtSender&) = delete;

    /// Takes the receiver that has connected. Throws Error.
    void accept();
    /// Sends a frame, unless as many as the host's credit allows are unacknowledged.
    void send(std::span<const std::byte> frame);

  private:
    SrtManner manner_;
    int listener_ = -1, socket_ = -1;
    std::uint32_t frames_ = 0;
};

/// Receives frames over SRT on a thread of its own.
class SrtReceiver {
  public:
    /// Connects from the calling thread's network. `take` gets each whole frame, on another thread.
    /// Throws Error.
    SrtReceiver(const SrtManner& manner, const std::string& address, int port,
                std::function<void(std::span<const std::byte>)> take);
    ~SrtReceiver();
    SrtReceiver(const SrtReceiver&) = delete;
    SrtReceiver& operator=(const SrtReceiver&) = delete;

  private:
    void run();
    void take_packet(std::span<const std::byte> packet);

    /// A frame of which packets have come.
    struct Partial {
        std::uint32_t frame = 0;
        std::size_t missing = 0;  ///< packets
        std::vector<std::byte> bytes;
        std::vector<bool> has;
    };

    SrtManner manner_;
    int socket_ = -1;
    std::function<void(std::span<const std::byte>)> take_;
    std::vector<Partial> partial_;
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
