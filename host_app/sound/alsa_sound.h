#pragma once

#include <memory>

#include "host_app/output/output_url.h"
#include "host_app/sound/sound_source.h"

namespace vantage {

/// A device of ALSA, with `channels=3,4` those of its channels. One that is missing or is unplugged
/// is silent, named, and tried again until it is there. Throws Error for options that cannot be.
std::shared_ptr<SoundSource> open_alsa_sound(const OutputUrl& url, SoundTap tap);
/// Throws Error as that would, and opens nothing.
void check_alsa_sound(const OutputUrl& url);

}  // namespace vantage
