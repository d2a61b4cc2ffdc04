#pragma once

#include <memory>

#include "host_app/output/output_url.h"
#include "host_app/sound/sound_source.h"

namespace vantage {

/// A file's sound from the programme's first tick on, `loop=yes`: again and again. Throws Error if
/// it has none.
std::shared_ptr<SoundSource> open_file_sound(const OutputUrl& url);

}  // namespace vantage
