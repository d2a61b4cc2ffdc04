#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/take/format/frame_storage.h"
#include "common/take/take_writer.h"

namespace vantage {

/// What a rig of a test sends: the frame of pulse k as it comes over the wire; every fourth has a
/// right picture.
PackedFrame sent_frame(const std::string& rig, std::uint64_t pulse, int jpeg_quality = 85);

/// Facts of a take at 25 pulses a second of rigs that send as above, from pulse `first` on.
TakeFacts small_facts(const std::vector<std::string>& rigs, std::uint64_t first,
                      int jpeg_quality = 85);

/// Writes pulses of all rigs; those named in `gaps` are left out of the last rig.
void write_small_take(const std::filesystem::path& path, const std::vector<std::string>& rigs,
                      std::uint64_t first, std::uint64_t last,
                      const std::vector<std::uint64_t>& gaps = {});

std::vector<std::byte> bytes_of_file(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace vantage
