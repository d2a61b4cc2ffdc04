#include "host_app/sound/sound_source.h"

#include "common/base/error.h"

namespace vantage {
namespace {

OutputUrl url_of(const std::string& text) {
    OutputUrl url = OutputUrl::parse(text, "audio");
    if (url.scheme != "alsa" && url.scheme != "file")
        fail("the audio source {} is unknown: give alsa:DEVICE or a file", url.shown);
    return url;
}

}  // namespace

const char* key_of(SoundPhase phase) {
    switch (phase) {
        case SoundPhase::opening:
            break;
        case SoundPhase::on:
            return "on";
        case SoundPhase::failed:
            return "failed";
        case SoundPhase::ended:
            return "ended";
    }
    return "opening";
}

std::shared_ptr<SoundSource> open_sound(const std::string& text, SoundTap tap) {
    const OutputUrl url = url_of(text);
    return url.scheme == "alsa" ? open_alsa_sound(url, std::move(tap)) : open_file_sound(url);
}

void check_sound(const std::string& text) {
    const OutputUrl url = url_of(text);
    if (url.scheme == "alsa")
        check_alsa_sound(url);
    else
        (void)open_file_sound(url);
}

}  // namespace vantage
