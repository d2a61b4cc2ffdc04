#pragma once

#include <memory>

#include "common/take/take_reader.h"
#include "host_app/sound/sound_source.h"

namespace vantage {

/// Opens the sound of a take, addressed by the time at which it was heard. Precondition: the take
/// has sound. Reads some seconds ahead on a thread of its own, from `begin`, for a programme that
/// never waits.
std::shared_ptr<SoundSource> open_take_sound(std::shared_ptr<const TakeReader> take, TaiTime begin);
/// Opens it for reading on request, for film exports, which may wait.
std::shared_ptr<SoundSource> open_patient_take_sound(std::shared_ptr<const TakeReader> take);

}  // namespace vantage
