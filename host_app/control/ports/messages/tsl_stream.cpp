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
        if (std::exchange(is_after_dle_, false)) {
            if (byte == stx) {
                if (place_ == Place::inside) ++strays_;
                place_ = Place::inside;
                message_.clear();
            } else if (byte == dle) {
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
    if (place_ != Place::inside) {
        stray();
        return;
    }
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

void TslStream::stray() {
    if (std::exchange(place_, Place::stray) != Place::stray) ++strays_;
}

}  // namespace vantage
