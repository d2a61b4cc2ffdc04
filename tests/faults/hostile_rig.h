#pragma once

#include <atomic>
#include <cstdint>
#include <random>
#include <string>
#include <thread>
#include <vector>
#include <zmq.hpp>

#include "common/wire/curve_keys.h"
#include "common/wire/frame_codec.h"
#include "common/wire/link_message.h"

namespace vantage {

/// A rig with a valid key that attacks its host: it sends a thousand messages per second, whatever
/// credit it has, and chooses the next one from a seed. Among them are right frames, frames of
/// other pulses, sizes, calibrations, clocks and contents, impossible counts and states, refusals,
/// reports that nobody asked for, and damaged bytes. Runs on a thread of its own.
class HostileRig {
  public:
    /// `period`: of the stage's pulses.
    HostileRig(std::string name, std::chrono::nanoseconds period, unsigned seed);
    ~HostileRig();
    HostileRig(const HostileRig&) = delete;
    HostileRig& operator=(const HostileRig&) = delete;

    std::string endpoint() const { return endpoint_; }
    std::string public_key() const { return keys_.public_key; }
    /// The kinds of attacks; kind 0 is a right frame.
    static constexpr int kinds = 20;
    /// Messages sent so far.
    std::uint64_t sent() const { return sent_; }

  private:
    using Parts = std::vector<std::vector<std::byte>>;

    void run();
    Parts next_message();
    void spoil(RigFrame& frame, int kind);
    void spoil(RigMessage& message, int kind);
    void damage(Parts& parts);
    std::uint64_t any(std::uint64_t below) { return random_() % below; }
    double between(double lowest, double highest);

    const std::string name_;
    const std::chrono::nanoseconds period_;
    std::mt19937_64 random_;
    const CurveKeys keys_ = generate_curve_keys();
    zmq::context_t context_;
    zmq::socket_t socket_;
    std::string endpoint_;
    FrameEncoder lossless_{0}, jpeg_{60};
    std::vector<std::byte> huge_;  ///< a black image of the largest size
    std::uint64_t session_ = 1, link_ = 1, frames_ = 0;
    std::atomic<std::uint64_t> sent_ = 0;
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace vantage
