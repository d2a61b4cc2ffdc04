#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

#include "common/av/sound.h"

namespace vantage {

/// Silence with a click of one millisecond at every full second from the first: of increasing level
/// on the left, of constant level on the right.
inline std::vector<float> clicks(double duration_s) {
    const auto count = static_cast<std::size_t>(duration_s * sound_rate_hz);
    std::vector<float> samples(count * sound_channels);
    constexpr std::size_t length = sound_rate_hz / 1000;
    for (std::size_t at = sound_rate_hz; at + length <= count; at += sound_rate_hz)
        for (std::size_t i = at; i < at + length; ++i) {
            samples[2 * i] = 0.25F + 0.01F * static_cast<float>(at / sound_rate_hz);
            samples[2 * i + 1] = 0.5F;
        }
    return samples;
}

/// The samples at which silence ends.
inline std::vector<std::int64_t> found_clicks(std::span<const float> samples) {
    std::vector<std::int64_t> found;
    constexpr float loud = 0.15F;
    constexpr std::int64_t apart = sound_rate_hz / 10;
    for (std::size_t i = 0; i < samples.size() / sound_channels; ++i) {
        const auto at = static_cast<std::int64_t>(i);
        if (samples[2 * i + 1] > loud && (found.empty() || at - found.back() > apart))
            found.push_back(at);
    }
    return found;
}

/// Writes a 16-bit WAV file.
inline void write_wav(const std::filesystem::path& path, std::span<const float> samples,
                      int rate_hz = sound_rate_hz) {
    std::ofstream out(path, std::ios::binary);
    const auto number = [&](std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) out.put(static_cast<char>(value >> (8 * i) & 255));
    };
    const std::uint64_t bytes = 2 * samples.size();
    out << "RIFF";
    number(36 + bytes, 4);
    out << "WAVEfmt ";
    number(16, 4);
    number(1, 2);
    number(sound_channels, 2);
    number(static_cast<std::uint64_t>(rate_hz), 4);
    number(static_cast<std::uint64_t>(rate_hz) * 4, 4);
    number(4, 2);
    number(16, 2);
    out << "data";
    number(bytes, 4);
    for (const float value : samples)
        number(static_cast<std::uint16_t>(static_cast<std::int16_t>(value * 32767)), 2);
}

}  // namespace vantage
