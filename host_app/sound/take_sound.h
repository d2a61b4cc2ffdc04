#pragma once

#include <memory>

#include "common/take/take_reader.h"
#include "host_app/sound/sound_source.h"

namespace vantage {

/// The sound of a take, by when it was heard. Precondition: the take has one.
///
/// Read some seconds ahead on a thread of its own, from `begin` on, for a programme that never
/// waits.
std::shared_ptr<SoundSource> open_take_sound(std::shared_ptr<const TakeReader> take, TaiTime begin);
/// Read when it is asked for, for a film that has time.
std::shared_ptr<SoundSource> open_patient_take_sound(std::shared_ptr<const TakeReader> take);

}  // namespace vantage
