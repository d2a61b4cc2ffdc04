#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// The last input that a decoder refused, for bug reports.
struct RefusedInput {
    std::string decoder;      ///< "TSL", "FreeD", "host message"
    std::string reason;       ///< the sentence of the refusal
    std::string hex;          ///< the first `max_refused_bytes` of the input
    std::size_t bytes = 0;    ///< size of the whole input
    std::uint64_t count = 0;  ///< refusals by this decoder since the start
};
inline constexpr std::size_t max_refused_bytes = 256;

/// Keeps an input that came from another program as the last refused one of this decoder. Logs it
/// at most once a minute for each decoder. Do not pass inputs that hold secrets: pages of the web
/// control, keys, passphrases. Thread-safe.
void note_refused_input(std::string_view decoder, std::span<const std::byte> input,
                        std::string_view reason);

/// The last refused input of every decoder of this process.
std::vector<RefusedInput> refused_inputs();

}  // namespace vantage
