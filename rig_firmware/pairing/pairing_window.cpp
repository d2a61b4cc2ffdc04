#include "rig_firmware/pairing/pairing_window.h"

#include <utility>

#include "common/base/error.h"

namespace vantage {

PairingWindow::PairingWindow(CurveKeys keys, PairOffer offer, const Limits& limits,
                             MonotonicTime now)
    : keys_(std::move(keys)),
      offer_(std::move(offer)),
      limits_(limits),
      end_(now + limits.open_for) {}

std::vector<PairingWindow::Outgoing> PairingWindow::hear(const std::string& route,
                                                         const PairMessage& message,
                                                         MonotonicTime now) {
    if (is_closed()) return {{route, PairRefusal{"this rig is not open for pairing any more"}}};
    const bool is_its_own = attempt_ && attempt_->route == route;
    if (const auto* commit = std::get_if<PairCommit>(&message)) {
        if (attempt_ && !is_its_own)
            return {{route, PairRefusal{"the rig is pairing with another host; try again later"}}};
        if (attempt_) (void)fail_attempt("the host began anew", now);
        return is_closed() ? std::vector<Outgoing>{{route, PairRefusal{why_closed_}}}
                           : begin(route, *commit, now);
    }
    if (!is_its_own)
        return {{route, PairRefusal{"the rig knows nothing of this pairing; begin anew"}}};
    try {
        const bool had_code = attempt_->pairing.code().has_value();
        attempt_->pairing.hear(message);
        if (!had_code) attempt_->end = now + limits_.compare_in;
        if (attempt_->pairing.is_agreed()) paired_ = attempt_->pairing.host();
        return {};
    } catch (const Error& error) {
        return fail_attempt(error.what(), now);
    }
}

std::vector<PairingWindow::Outgoing> PairingWindow::hear_nonsense(const std::string& route,
                                                                  const std::string& why,
                                                                  MonotonicTime now) {
    if (attempt_ && attempt_->route == route) return fail_attempt(why, now);
    return {{route, PairRefusal{why}}};
}

std::vector<PairingWindow::Outgoing> PairingWindow::begin(const std::string& route,
                                                          const PairCommit& commit,
                                                          MonotonicTime now) {
    ++attempts_made_;
    attempt_ = {route, RigPairing(keys_, offer_, commit), now + limits_.answer_in};
    return {{route, attempt_->pairing.offer()}};
}

std::vector<PairingWindow::Outgoing> PairingWindow::fail_attempt(const std::string& why,
                                                                 MonotonicTime now) {
    std::vector<Outgoing> answer{{attempt_->route, PairRefusal{why}}};
    failure_ = why;
    attempt_.reset();
    close_if_over(now);
    return answer;
}

void PairingWindow::close_if_over(MonotonicTime now) {
    if (is_closed() || attempt_) return;
    if (attempts_made_ >= limits_.attempts)
        why_closed_ = fmt::format(
            "{} attempts to pair were made and none was confirmed on both sides; open it again "
            "with: vantage-rig pair",
            attempts_made_);
    else if (now >= end_)
        why_closed_ =
            "nobody has paired in time; open it again with: vantage-rig pair, then: vantage setup "
            "at the host";
}

std::vector<PairingWindow::Outgoing> PairingWindow::tick(MonotonicTime now) {
    if (!is_closed() && attempt_ && now >= attempt_->end)
        return fail_attempt(attempt_->pairing.code() ? "the codes were not compared in time"
                                                     : "the host did not answer in time",
                            now);
    close_if_over(now);
    return {};
}

const RigPairing* PairingWindow::to_compare() const {
    const bool is_shown =
        !is_closed() && attempt_ && attempt_->pairing.code() && !attempt_->pairing.is_confirmed();
    return is_shown ? &attempt_->pairing : nullptr;
}

std::vector<PairingWindow::Outgoing> PairingWindow::confirm() {
    std::vector<Outgoing> answer{{attempt_->route, attempt_->pairing.confirm()}};
    if (attempt_->pairing.is_agreed()) paired_ = attempt_->pairing.host();
    return answer;
}

std::vector<PairingWindow::Outgoing> PairingWindow::reject(MonotonicTime now) {
    return fail_attempt("the person at the rig says that the codes are not the same", now);
}

}  // namespace vantage
