#pragma once

#include <memory>

#include "host_app/output/output_url.h"
#include "host_app/sound/sound_source.h"

namespace vantage {

/// Opens an ALSA device, with `channels=3,4` for some of its channels. A missing or unplugged
/// device is silent, is logged, and is tried again until it is there. Throws Error for invalid
/// options.
std::shared_ptr<SoundSource> open_alsa_sound(const OutputUrl& url, SoundTap tap);
/// Throws the same Error without opening the device.
void check_alsa_sound(const OutputUrl& url);

}  // namespace vantage
