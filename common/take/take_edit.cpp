#include "common/take/take_edit.h"

#include <algorithm>
#include <set>

#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/timecode.h"

namespace vantage {
namespace {

/// A frame of one of the source takes.
struct Source {
    std::uint64_t pulse = 0;
    std::size_t rig = 0;  ///< index in the copy
    std::size_t take = 0, rig_there = 0, frame = 0;
};

bool is_before(const Source& a, const Source& b) {
    return std::tie(a.pulse, a.rig, a.take) < std::tie(b.pulse, b.rig, b.take);
}

/// The rigs of all takes, each once.
std::vector<TakeRig> rigs_of(const std::vector<const TakeReader*>& takes) {
    std::vector<TakeRig> rigs;
    for (const TakeReader* take : takes) {
        if (take->facts().pulse_rate_hz != takes.front()->facts().pulse_rate_hz)
            fail("{} has {} pulses per second and {} has {}: they are of different stages",
                 takes.front()->path().string(), takes.front()->facts().pulse_rate_hz,
                 take->path().string(), take->facts().pulse_rate_hz);
        for (std::size_t i = 0; i < take->facts().rigs.size(); ++i) {
            const TakeRig& rig = take->facts().rigs[i];
            const auto known = std::find_if(rigs.begin(), rigs.end(), [&](const TakeRig& each) {
                return each.name == rig.name;
            });
            if (known == rigs.end())
                rigs.push_back(rig);
            else if (*known != rig && !take->frames(i).empty())
                fail(
                    "rig {} of {} has images of another size or codec than in the take before "
                    "it: such takes cannot be joined",
                    rig.name, take->path().string());
        }
    }
    return rigs;
}

std::vector<Source> sources_of(const std::vector<const TakeReader*>& takes,
                               const std::vector<TakeRig>& rigs, std::uint64_t from,
                               std::uint64_t to) {
    std::vector<Source> sources;
    for (std::size_t t = 0; t < takes.size(); ++t)
        for (std::size_t there = 0; there < takes[t]->facts().rigs.size(); ++there) {
            const auto rig = std::find_if(rigs.begin(), rigs.end(), [&](const TakeRig& each) {
                return each.name == takes[t]->facts().rigs[there].name;
            });
            const std::vector<TakeReader::Frame>& frames = takes[t]->frames(there);
            for (std::size_t f = 0; f < frames.size(); ++f)
                if (frames[f].pulse >= from && frames[f].pulse < to)
                    sources.push_back({frames[f].pulse,
                                       static_cast<std::size_t>(rig - rigs.begin()), t, there, f});
        }
    std::sort(sources.begin(), sources.end(), is_before);
    return sources;
}

std::vector<CameraRecord> cameras_of(const std::vector<const TakeReader*>& takes, TaiTime from,
                                     TaiTime to) {
    std::vector<CameraRecord> cameras;
    for (const TakeReader* take : takes)
        for (const CameraRecord& camera : take->cameras())
            if (camera.time >= from && camera.time < to) cameras.push_back(camera);
    std::stable_sort(cameras.begin(), cameras.end(),
                     [](const CameraRecord& a, const CameraRecord& b) { return a.time < b.time; });
    cameras.erase(std::unique(cameras.begin(), cameras.end(),
                              [](const CameraRecord& a, const CameraRecord& b) {
                                  return a.time == b.time && a.tick == b.tick;
                              }),
                  cameras.end());
    return cameras;
}

/// Sound of one of the source takes.
struct SoundSourceOf {
    const TakeReader* take;
    const TakeReader::Sound* sound;
};

std::vector<SoundSourceOf> sounds_of(const std::vector<const TakeReader*>& takes) {
    std::vector<SoundSourceOf> sounds;
    for (const TakeReader* take : takes)
        for (const TakeReader::Sound& sound : take->sounds()) sounds.push_back({take, &sound});
    std::stable_sort(sounds.begin(), sounds.end(),
                     [](const SoundSourceOf& a, const SoundSourceOf& b) {
                         return a.sound->first < b.sound->first;
                     });
    return sounds;
}

/// Copies sound in the order of its time, from the take's origin to its end.
class SoundCopy {
  public:
    SoundCopy(const std::vector<const TakeReader*>& takes, TaiTime end, TakeWriter& writer,
              TakeCopy& copy)
        : sounds_(sounds_of(takes)), end_(sound_sample_at(end)), writer_(writer), copy_(copy) {}

    /// Writes the sound that begins by `time`.
    void write_until(TaiTime time) {
        if (!writer_.facts().has_sound) return;
        const std::int64_t until = std::min(sound_sample_at(time), end_);
        for (; at_ < sounds_.size() && sounds_[at_].sound->first < until; ++at_) {
            const TakeReader::Sound& sound = *sounds_[at_].sound;
            try {
                std::vector<std::byte> bytes = sounds_[at_].take->load(sound);
                if (sound.end() > end_)
                    bytes.resize(static_cast<std::size_t>(end_ - sound.first) * stored_sound_bytes);
                writer_.add_sound(sound.first, bytes);
            } catch (const TakeDamaged&) {
                ++copy_.damaged;
            }
        }
        copy_.sound_s = writer_.sound_s();
    }

  private:
    std::vector<SoundSourceOf> sounds_;
    std::size_t at_ = 0;
    std::int64_t end_;
    TakeWriter& writer_;
    TakeCopy& copy_;
};

void write(const std::vector<const TakeReader*>& takes, const std::vector<Source>& sources,
           TakeWriter& writer, TakeCopy& copy, const std::function<void(double)>& progress) {
    const PulseGrid pulses(writer.facts().pulse_rate_hz);
    const std::vector<CameraRecord> cameras =
        cameras_of(takes, writer.facts().origin, pulses.time_of(sources.back().pulse + 1));
    const TaiTime end = pulses.time_of(sources.back().pulse + 1);
    SoundCopy sounds(takes, end, writer, copy);
    auto camera = cameras.begin();
    std::optional<std::pair<std::uint64_t, std::size_t>> written;
    std::size_t done = 0;
    for (const Source& source : sources) {
        constexpr std::size_t now_and_then = 500;
        if (++done % now_and_then == 0 && progress)
            progress(static_cast<double>(done) / static_cast<double>(sources.size()));
        for (; camera != cameras.end() && camera->time <= pulses.time_of(source.pulse); ++camera)
            copy.cameras += writer.add(*camera);
        sounds.write_until(pulses.time_of(source.pulse));
        if (written == std::pair(source.pulse, source.rig)) {
            ++copy.twice;
            continue;
        }
        const TakeReader& take = *takes[source.take];
        try {
            StoredFrame frame =
                take.load(source.rig_there, take.frames(source.rig_there)[source.frame]);
            copy.frames += writer.add(source.rig, std::move(frame));
            written.emplace(source.pulse, source.rig);
        } catch (const TakeDamaged&) {
            ++copy.damaged;
        }
    }
    for (; camera != cameras.end(); ++camera) copy.cameras += writer.add(*camera);
    sounds.write_until(end);
    writer.finish();
}

}  // namespace

TakeCopy copy_takes(const std::vector<const TakeReader*>& takes, std::uint64_t from,
                    std::uint64_t to, const std::filesystem::path& path,
                    const std::function<void(double)>& progress) {
    require_new_take(path, "written");
    TakeFacts facts = takes.front()->facts();
    facts.rigs = rigs_of(takes);
    facts.has_sound = std::any_of(takes.begin(), takes.end(),
                                  [](const TakeReader* take) { return take->facts().has_sound; });
    const std::vector<Source> sources = sources_of(takes, facts.rigs, from, to);
    if (sources.empty()) fail("{} is not written: the range has no frames", path.string());
    const Source& first = sources.front();
    const TakeReader::Frame& frame = takes[first.take]->frames(first.rig_there)[first.frame];
    facts.origin = takes[first.take]->facts().origin + std::chrono::milliseconds(frame.time_ms);
    const PulseGrid pulses(facts.pulse_rate_hz);
    // The file's times are in milliseconds; the grid has the exact time of a pulse.
    if (const TaiTime exact = pulses.time_of(first.pulse);
        std::chrono::abs(exact - facts.origin) <= std::chrono::milliseconds(1))
        facts.origin = exact;
    facts.timecode = TimecodeClock(facts.pulse_rate_hz).at(facts.origin, facts.tai_offset_s);

    std::filesystem::path partial = path;
    partial += ".partial";
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    TakeCopy copy;
    try {
        TakeWriter writer(partial, facts);
        write(takes, sources, writer, copy, progress);
    } catch (...) {
        std::filesystem::remove(partial, ignored);
        throw;
    }
    std::error_code error;
    std::filesystem::rename(partial, path, error);
    if (error) fail("cannot write {}: {}", path.string(), error.message());
    return copy;
}

}  // namespace vantage
