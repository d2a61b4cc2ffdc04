#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/base/time/time.h"
#include "common/pairing/pairing.h"

namespace vantage {

/// The time in which a person at the rig lets hosts pair: one host at a time, few attempts, and
/// none that waits for ever. Knows no socket: a route names a connection.
class PairingWindow {
  public:
    struct Limits {
        std::chrono::nanoseconds open_for = std::chrono::minutes(5);
        std::chrono::nanoseconds answer_in = std::chrono::seconds(10);  ///< of a host's program
        std::chrono::nanoseconds compare_in = std::chrono::minutes(2);  ///< of both persons
        int attempts = 3;
    };
    struct Outgoing {
        std::string route;
        PairMessage message;
    };

    /// `offer`: without nonce and key.
    PairingWindow(CurveKeys keys, PairOffer offer, const Limits& limits, MonotonicTime now);

    std::vector<Outgoing> hear(const std::string& route, const PairMessage& message,
                               MonotonicTime now);
    /// What came on a route and was no message: an attempt that it belongs to is over.
    std::vector<Outgoing> hear_nonsense(const std::string& route, const std::string& why,
                                        MonotonicTime now);
    /// Ends what has taken too long.
    std::vector<Outgoing> tick(MonotonicTime now);

    /// Whose code the person here is to compare; null: nobody's.
    const RigPairing* to_compare() const;
    /// He has found both the same, or not. Precondition: there is one to compare.
    std::vector<Outgoing> confirm();
    std::vector<Outgoing> reject(MonotonicTime now);

    /// The host that both persons have confirmed: the window is closed with that.
    const std::optional<PairReveal>& paired() const { return paired_; }
    bool is_closed() const { return paired_ || !why_closed_.empty(); }
    /// A sentence; empty as long as it is open, and where a host is paired.
    const std::string& why_closed() const { return why_closed_; }
    /// Why the latest attempt has failed, once; else empty.
    std::string take_failure() { return std::exchange(failure_, {}); }
    int attempts_made() const { return attempts_made_; }

  private:
    struct Attempt {
        std::string route;
        RigPairing pairing;
        MonotonicTime end;
    };
    std::vector<Outgoing> fail_attempt(const std::string& why, MonotonicTime now);
    std::vector<Outgoing> begin(const std::string& route, const PairCommit& commit,
                                MonotonicTime now);
    void close_if_over(MonotonicTime now);

    CurveKeys keys_;
    PairOffer offer_;
    Limits limits_;
    MonotonicTime end_;
    std::optional<Attempt> attempt_;
    int attempts_made_ = 0;
    std::optional<PairReveal> paired_;
    std::string why_closed_, failure_;
};

}  // namespace vantage
