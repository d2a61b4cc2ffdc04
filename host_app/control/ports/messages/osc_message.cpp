#include "host_app/control/ports/messages/osc_message.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>

#include <lo/lo.h>
#include <lo/lo_lowlevel.h>

namespace vantage {
namespace {

constexpr int deepest_bundle = 4;
constexpr std::size_t most_messages = 256, most_address_bytes = 128;

struct FreeMessage {
    void operator()(lo_message message) const { lo_message_free(message); }
};
/// lo_message is a pointer to void in liblo 0.31, and to a type of its own in 0.32.
using Message = std::unique_ptr<std::remove_pointer_t<lo_message>, FreeMessage>;

std::uint32_t big_endian(std::span<const std::byte> bytes) {
    std::uint32_t value = 0;
    for (const std::byte byte : bytes.first(4))
        value = value << 8 | std::to_integer<std::uint32_t>(byte);
    return value;
}

/// Reads a number of 64 bits, which OSC aligns to four bytes only.
template <class Number>
Number number_at(const void* argument) {
    Number number{};
    std::memcpy(&number, argument, sizeof number);
    return number;
}

bool decode_message(std::span<const std::byte> bytes, std::vector<OscMessage>& into) {
    // liblo requires writable memory and swaps the bytes of numbers in place.
    std::vector<std::byte> copy(bytes.begin(), bytes.end());
    if (copy.empty() || copy.front() != std::byte{'/'} ||
        std::find(copy.begin(), copy.end(), std::byte{0}) == copy.end())
        return false;
    OscMessage message;
    message.address = reinterpret_cast<const char*>(copy.data());
    if (message.address.size() > most_address_bytes) return false;
    int result = 0;
    const Message parsed(lo_message_deserialise(copy.data(), copy.size(), &result));
    if (!parsed) return false;
    const std::string_view types = lo_message_get_types(parsed.get());
    lo_arg** arguments = lo_message_get_argv(parsed.get());
    for (std::size_t i = 0; i < types.size(); ++i) {
        switch (types[i]) {
            case LO_INT32:
                message.numbers.push_back(number_at<std::int32_t>(arguments[i]));
                break;
            case LO_INT64:
                message.numbers.push_back(
                    static_cast<double>(number_at<std::int64_t>(arguments[i])));
                break;
            case LO_FLOAT:
                message.numbers.push_back(static_cast<double>(number_at<float>(arguments[i])));
                break;
            case LO_DOUBLE:
                message.numbers.push_back(number_at<double>(arguments[i]));
                break;
            case LO_TRUE:
                message.numbers.push_back(1);
                break;
            case LO_FALSE:
                message.numbers.push_back(0);
                break;
            case LO_STRING:
                // Arguments are aligned to four bytes, not to eight.
                message.words.emplace_back(reinterpret_cast<const char*>(arguments[i]));
                break;
            default:
                message.has_others = true;
        }
    }
    into.push_back(std::move(message));
    return into.size() <= most_messages;
}

bool decode_element(std::span<const std::byte> bytes, int depth, std::vector<OscMessage>& into) {
    constexpr std::string_view bundle("#bundle\0", 8);
    constexpr std::size_t head_bytes = bundle.size() + 8;
    if (bytes.empty() || bytes.size() % 4 != 0) return false;
    if (bytes.size() < bundle.size() ||
        std::memcmp(bytes.data(), bundle.data(), bundle.size()) != 0)
        return decode_message(bytes, into);
    if (bytes.size() < head_bytes || depth >= deepest_bundle) return false;
    bytes = bytes.subspan(head_bytes);
    while (!bytes.empty()) {
        if (bytes.size() < 4) return false;
        const std::uint32_t size = big_endian(bytes);
        bytes = bytes.subspan(4);
        if (size > bytes.size() || !decode_element(bytes.first(size), depth + 1, into))
            return false;
        bytes = bytes.subspan(size);
    }
    return true;
}

}  // namespace

std::optional<std::vector<OscMessage>> decode_osc(std::span<const std::byte> datagram) {
    std::vector<OscMessage> messages;
    if (!decode_element(datagram, 0, messages)) return std::nullopt;
    return messages;
}

std::vector<std::byte> encode_osc(const std::string& address, const LampValue& value) {
    const Message message(lo_message_new());
    if (const bool* is_on = std::get_if<bool>(&value))
        lo_message_add_int32(message.get(), *is_on ? 1 : 0);
    else if (const double* number = std::get_if<double>(&value))
        lo_message_add_float(message.get(), static_cast<float>(*number));
    else
        lo_message_add_string(message.get(), std::get<std::string>(value).c_str());
    std::vector<std::byte> bytes(lo_message_length(message.get(), address.c_str()));
    lo_message_serialise(message.get(), address.c_str(), bytes.data(), nullptr);
    return bytes;
}

}  // namespace vantage
