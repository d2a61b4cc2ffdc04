#pragma once

#include <memory>

#include "host_app/output/output_url.h"
#include "host_app/sound/sound_source.h"

namespace vantage {

/// Opens a sound file that starts with the programme's first tick; `loop=yes` repeats it. Throws
/// Error if the file has no sound.
std::shared_ptr<SoundSource> open_file_sound(const OutputUrl& url);

}  // namespace vantage
