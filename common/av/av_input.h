#pragma once

#include <filesystem>

#include "common/av/av_handles.h"

namespace vantage {

/// Opens a media file; its name is never taken as a URL. FFmpeg's messages go to our log. Returns
/// null and FFmpeg's code if the file cannot be opened.
AvInputPtr open_av_input(const std::filesystem::path& file, int& code);

/// Reads what the file tells about its streams and returns the number of the best one of this type,
/// or FFmpeg's negative code. `decoder` is set to the one for it, unless it is null.
int find_av_stream(AVFormatContext& input, AVMediaType type, const AVCodec** decoder = nullptr);

/// Opens a decoder for the stream. Returns FFmpeg's code, negative if it cannot be opened.
/// `threads` of 0 are one for each processor.
int open_av_decoder(const AVStream& stream, const AVCodec& decoder, int threads,
                    AvCodecContextPtr& opened);

}  // namespace vantage
