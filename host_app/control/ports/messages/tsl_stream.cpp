#include "host_app/control/ports/messages/tsl_stream.h"

#include <utility>

#include "host_app/control/ports/messages/tsl_message.h"

namespace vantage {
namespace {

constexpr char dle = '\xfe', stx = '\x02';

std::size_t byte_at(const std::string& bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}

}  // namespace

std::vector<std::string> TslStream::take(std::string_view bytes) {
    std::vector<std::string> whole;
    for (const char byte : bytes) {
        if (place_ == Place::bare) {
            append_bare(byte, whole);
        } else if (std::exchange(is_after_dle_, false)) {
            if (byte == stx) {
                if (place_ == Place::inside) ++strays_;
                place_ = Place::inside;
                message_.clear();
            } else if (byte == dle && place_ == Place::inside) {
                append(byte, whole);
            } else {
                stray();
            }
        } else if (byte == dle) {
            is_after_dle_ = true;
        } else {
            append(byte, whole);
        }
    }
    return whole;
}

void TslStream::append(char byte, std::vector<std::string>& whole) {
    if (place_ == Place::outside) {
        place_ = Place::bare;
        message_.clear();
        return append_bare(byte, whole);
    }
    if (place_ != Place::inside) return stray();
    message_ += byte;
    constexpr std::size_t count_bytes = 2;
    if (message_.size() < count_bytes) return;
    const std::size_t size = count_bytes + (byte_at(message_, 0) | byte_at(message_, 1) << 8);
    if (size > most_tsl_bytes) {
        stray();
    } else if (message_.size() == size) {
        whole.push_back(std::move(message_));
        place_ = Place::outside;
    }
}

/// Appends a byte of a message without framing. Bytes that cannot be its header are dropped.
void TslStream::append_bare(char byte, std::vector<std::string>& whole) {
    constexpr std::size_t bare_v3_bytes = 18, bare_v3_first = 0x80, reserved_bits = 0xc0,
                          count_bytes = 2;
    constexpr std::size_t version_at = 2, flags_at = 3, most_flags = 3, least_bytes = 6;
    message_ += byte;
    const std::size_t length = message_.size();
    const bool is_v3 = byte_at(message_, 0) >= bare_v3_first;
    std::size_t size = bare_v3_bytes;
    bool is_head = true;
    if (is_v3) {
        is_head = length != 2 || (byte_at(message_, 1) & reserved_bits) == 0;
    } else if (length >= count_bytes) {
        size = count_bytes + (byte_at(message_, 0) | byte_at(message_, 1) << 8);
        is_head = size >= least_bytes && size <= most_tsl_bytes &&
                  (length <= version_at || byte_at(message_, version_at) == 0) &&
                  (length <= flags_at || byte_at(message_, flags_at) <= most_flags);
    }
    if (!is_head) {
        stray();
        is_after_dle_ = byte == dle;
    } else if (length == size) {
        whole.push_back(std::move(message_));
        message_.clear();
        place_ = Place::outside;
    }
}

void TslStream::stray() {
    if (std::exchange(place_, Place::stray) != Place::stray) ++strays_;
}

}  // namespace vantage
