#include "common/receive/link_account.h"

#include "common/base/error.h"

namespace vantage {

std::uint64_t LinkAccount::hear(const RigMessage& message, bool with_frame) {
    const std::uint64_t known_before = message.link == link_ ? known_ : 0;
    const std::uint64_t expected = known_before + (with_frame ? 1 : 0);
    const std::uint64_t sent = message.counters.sent;
    if (sent < expected)
        fail("rig {} counts {} frames sent where {} came already", message.rig, sent, expected);
    link_ = message.link;
    known_ = sent;
    lost_ += sent - expected;
    return sent - expected;
}

}  // namespace vantage
