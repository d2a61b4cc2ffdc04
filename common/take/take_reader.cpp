#include "common/take/take_reader.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "common/base/error.h"

namespace vantage {
namespace {

/// Matroska's element identifiers (RFC 9559).
namespace id {
constexpr std::uint64_t ebml = 0x1A45DFA3, segment = 0x18538067, cluster = 0x1F43B675,
                        tracks = 0x1654AE6B, track_entry = 0xAE, track_number = 0xD7, name = 0x536E,
                        codec = 0x86, codec_private = 0x63A2, video = 0xE0, pixel_width = 0xB0,
                        pixel_height = 0xBA, attachments = 0x1941A469, attached_file = 0x61A7,
                        file_name = 0x466E, file_mime_type = 0x4660, file_data = 0x465C,
                        cluster_time = 0xE7, simple_block = 0xA3, block_group = 0xA0, block = 0xA1,
                        cues = 0x1C53BB6B;
}  // namespace id

/// The largest attachment that Vantage writes.
constexpr std::uint64_t most_attached_bytes = 16 << 20;
constexpr std::size_t most_rigs = 64;
/// The number of damaged places that are listed; a file that is not a take has millions.
constexpr std::size_t most_damage = 1000;

std::string text_of(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Removes the Windows header, in which libavformat stores FFV1's, from `setup`.
TakePictures::Codec codec_of(const std::string& track, const std::string& codec,
                             std::vector<std::byte>& setup) {
    constexpr std::size_t header_bytes = 40, fourcc_at = 16;
    if (codec == "V_MJPEG") return TakePictures::Codec::jpeg;
    if (codec == "V_FFV1") return TakePictures::Codec::ffv1;
    if (codec == "V_MS/VFW/FOURCC" && setup.size() >= header_bytes &&
        std::memcmp(setup.data() + fourcc_at, "FFV1", 4) == 0) {
        setup.erase(setup.begin(), setup.begin() + header_bytes);
        return TakePictures::Codec::ffv1;
    }
    fail("its track {} has the codec {}, which is neither JPEG nor FFV1", track, codec);
}

int side(std::optional<std::uint64_t> number) {
    constexpr std::uint64_t longest_px = 4096;
    if (!number || *number < 1 || *number > longest_px)
        fail("a side of a track's image is not 1 to {} pixels", longest_px);
    return static_cast<int>(*number);
}

}  // namespace

struct TakeReader::HeadTrack {
    std::uint64_t number = 0;
    std::string name, codec;
    TakePictures pictures;
};

TakeReader::TakeReader(std::filesystem::path path) : path_(std::move(path)), file_(path_) {
    try {
        read_head();
    } catch (const Error& error) {
        fail("{} cannot be read as a take: {}", path_.string(), error.what());
    }
    sort_frames();
    sort_sounds();
}

void TakeReader::add_damage(std::uint64_t at, std::string words) {
    if (damage_.size() < most_damage) damage_.push_back({at, std::move(words)});
}

void TakeReader::read_head() {
    const auto ebml = file_.element(0, file_.size());
    if (!ebml || ebml->id != id::ebml) fail("it is not a Matroska file");
    const auto segment = file_.element(ebml->end, file_.size());
    // A file that was truncated after it was finished is shorter than its head states.
    const std::uint64_t begin = segment ? segment->inside : ebml->end + 12;
    if (segment && segment->id != id::segment) fail("it is not a Matroska file");
    segment_begin_ = begin;
    segment_end_ = segment ? segment->end : file_.size();
    if (!segment) add_damage(file_.size(), "the file is truncated: its head states more bytes");

    std::vector<HeadTrack> found;
    bool has_facts = false;
    std::uint64_t at = segment_begin_;
    while (at < segment_end_) {
        const auto element = file_.element(at, segment_end_);
        if (!element || element->id == id::cluster) break;
        if (element->is_open) fail("its head is damaged at byte {}", at);
        if (element->id == id::tracks) read_tracks(*element, found);
        if (element->id == id::attachments) {
            read_attachments(*element);
            has_facts = true;
        }
        at = element->end;
    }
    if (!has_facts || facts_.program.empty())
        fail("it is a Matroska file without take.json, so it is not a take");
    name_tracks(found);
    read_clusters(at);
}

void TakeReader::read_tracks(const EbmlFile::Element& tracks, std::vector<HeadTrack>& found) {
    for (std::uint64_t at = tracks.inside; at < tracks.end;) {
        const auto entry = file_.element(at, tracks.end);
        if (!entry) fail("its list of tracks is damaged at byte {}", at);
        at = entry->end;
        if (entry->id != id::track_entry) continue;
        HeadTrack& track = found.emplace_back();
        for (std::uint64_t inner = entry->inside; inner < entry->end;) {
            const auto part = file_.element(inner, entry->end);
            if (!part) fail("its list of tracks is damaged at byte {}", inner);
            inner = part->end;
            const std::uint64_t length = part->end - part->inside;
            if (part->id == id::track_number) track.number = file_.number(*part).value_or(0);
            if ((part->id == id::name || part->id == id::codec || part->id == id::codec_private) &&
                length > most_text_bytes)
                fail("a track's head is longer than {} bytes", most_text_bytes);
            if (part->id == id::name) track.name = text_of(file_.content(*part));
            if (part->id == id::codec) track.codec = text_of(file_.content(*part));
            if (part->id == id::codec_private) track.pictures.setup = file_.content(*part);
            if (part->id != id::video) continue;
            for (std::uint64_t deep = part->inside; deep < part->end;) {
                const auto size = file_.element(deep, part->end);
                if (!size) fail("its list of tracks is damaged at byte {}", deep);
                deep = size->end;
                if (size->id == id::pixel_width)
                    track.pictures.size_px.width = side(file_.number(*size));
                if (size->id == id::pixel_height)
                    track.pictures.size_px.height = side(file_.number(*size));
            }
        }
    }
}

void TakeReader::read_attachments(const EbmlFile::Element& attachments) {
    for (std::uint64_t at = attachments.inside; at < attachments.end;) {
        const auto file = file_.element(at, attachments.end);
        if (!file) fail("its attachments are damaged at byte {}", at);
        at = file->end;
        if (file->id != id::attached_file) continue;
        TakeAttachment attachment;
        for (std::uint64_t inner = file->inside; inner < file->end;) {
            const auto part = file_.element(inner, file->end);
            if (!part) fail("its attachments are damaged at byte {}", inner);
            inner = part->end;
            if (part->end - part->inside > most_attached_bytes)
                fail("an attachment is larger than {} bytes", most_attached_bytes);
            if (part->id == id::file_name) attachment.name = text_of(file_.content(*part));
            if (part->id == id::file_mime_type)
                attachment.mime_type = text_of(file_.content(*part));
            if (part->id == id::file_data) attachment.bytes = file_.content(*part);
        }
        if (attachment.name == "take.json") {
            std::vector<TakeAttachment> others = std::move(facts_.attachments);
            facts_ = take_facts_from(text_of(attachment.bytes));
            facts_.attachments = std::move(others);
        } else {
            facts_.attachments.push_back(std::move(attachment));
        }
    }
}

void TakeReader::name_tracks(const std::vector<HeadTrack>& found) {
    if (facts_.rigs.size() > most_rigs)
        fail("it has {} rigs, more than {}", facts_.rigs.size(), most_rigs);
    frames_.resize(facts_.rigs.size());
    for (const HeadTrack& track : found) {
        if (track.name == "camera") tracks_[track.number] = {Track::Kind::camera, 0};
        if (facts_.has_sound && track.name == "sound") {
            if (track.codec != "A_PCM/INT/LIT")
                fail("its sound has the codec {}, which takes do not use", track.codec);
            tracks_[track.number] = {Track::Kind::sound, 0};
        }
        if (facts_.has_sound && track.name == "sound times")
            tracks_[track.number] = {Track::Kind::sound_record, 0};
        for (std::size_t rig = 0; rig < facts_.rigs.size(); ++rig) {
            const std::string& name = facts_.rigs[rig].name;
            if (track.name == name + " frames") tracks_[track.number] = {Track::Kind::record, rig};
            const bool is_colour = track.name == name + " colour";
            if (!is_colour && track.name != name + " disparity") continue;
            TakePictures pictures = track.pictures;
            pictures.codec = codec_of(track.name, track.codec, pictures.setup);
            if (pictures.size_px.empty()) fail("its track {} has no size", track.name);
            tracks_[track.number] = {is_colour ? Track::Kind::colour : Track::Kind::depth, rig};
            (is_colour ? facts_.rigs[rig].colour : facts_.rigs[rig].depth) = std::move(pictures);
        }
    }
}

void TakeReader::read_clusters(std::uint64_t at) {
    while (at < segment_end_) {
        const auto element = file_.element(at, segment_end_);
        if (element && element->id == id::cluster && !element->is_open) {
            read_cluster(*element);
            at = element->end;
            continue;
        }
        // An end without a cluster's identifier is a truncation between two clusters.
        if (element && !element->is_open) {
            is_ended_ = is_ended_ || element->id == id::cues;
            at = element->end;
            continue;
        }
        const auto next = file_.find(static_cast<std::uint32_t>(id::cluster), at + 1);
        const std::uint64_t until = std::min(next.value_or(segment_end_), segment_end_);
        add_damage(at, next
                           ? fmt::format("{} bytes are not part of a take", until - at)
                           : fmt::format("the last {} bytes are truncated or damaged", until - at));
        at = until;
    }
}

void TakeReader::read_cluster(const EbmlFile::Element& cluster) {
    std::int64_t time_ms = -1;
    for (std::uint64_t at = cluster.inside; at < cluster.end;) {
        const auto element = file_.element(at, cluster.end);
        if (!element || element->is_open) {
            add_damage(
                at, fmt::format("the rest of a cluster, {} bytes, is damaged", cluster.end - at));
            return;
        }
        at = element->end;
        if (element->id == id::cluster_time) {
            constexpr std::uint64_t longest_ms = std::uint64_t{1} << 42;
            const auto number = file_.number(*element);
            if (number && *number <= longest_ms) time_ms = static_cast<std::int64_t>(*number);
        } else if (element->id == id::simple_block) {
            take_block(element->inside, element->end, time_ms);
        } else if (element->id == id::block_group) {
            for (std::uint64_t inner = element->inside; inner < element->end;) {
                const auto part = file_.element(inner, element->end);
                if (!part || part->is_open) {
                    add_damage(inner, "a block is damaged");
                    break;
                }
                if (part->id == id::block) take_block(part->inside, part->end, time_ms);
                inner = part->end;
            }
        }
    }
}

void TakeReader::take_block(std::uint64_t at, std::uint64_t end, std::int64_t cluster_ms) {
    constexpr std::size_t most_head = 8 + 3;
    const std::vector<std::byte> head =
        file_.bytes(at, static_cast<std::size_t>(std::min<std::uint64_t>(most_head, end - at)));
    const auto number = EbmlFile::var_int(head);
    if (!number || head.size() < number->length + 3 || cluster_ms < 0) {
        add_damage(at, "the head of a block is damaged");
        return;
    }
    const auto found = tracks_.find(number->value);
    if (found == tracks_.end()) {
        add_damage(at, fmt::format("a block belongs to track {}, which the take does not have",
                                   number->value));
        return;
    }
    const auto byte = [&](std::size_t i) {
        return std::to_integer<unsigned>(head[number->length + i]);
    };
    const std::int64_t time_ms =
        cluster_ms + static_cast<std::int16_t>(static_cast<std::uint16_t>(byte(0) << 8 | byte(1)));
    constexpr unsigned lacing = 0x06;
    const std::uint64_t inside = at + number->length + 3;
    if ((byte(2) & lacing) != 0 || end - inside > std::numeric_limits<std::uint32_t>::max()) {
        add_damage(at, "the head of a block is damaged");
        return;
    }
    const Block block{inside, static_cast<std::uint32_t>(end - inside)};
    const Track& track = found->second;
    switch (track.kind) {
        case Track::Kind::none:
            return;
        case Track::Kind::colour:
        case Track::Kind::depth: {
            // Its record precedes it.
            std::vector<Frame>& frames = frames_[track.rig];
            Block Frame::*const place =
                track.kind == Track::Kind::colour ? &Frame::colour : &Frame::depth;
            if (frames.empty() || frames.back().time_ms != time_ms ||
                (frames.back().*place).size != 0)
                add_damage(at, fmt::format("an image of rig {} has no record",
                                           facts_.rigs[track.rig].name));
            else
                frames.back().*place = block;
            return;
        }
        case Track::Kind::record:
            take_record(track.rig, time_ms, block);
            return;
        case Track::Kind::sound:
            take_sound(at, time_ms, block);
            return;
        case Track::Kind::sound_record:
            take_sound_record(time_ms, block);
            return;
        case Track::Kind::camera:
            try {
                if (block.size > most_text_bytes) fail("a camera's record is too long");
                cameras_.push_back(camera_record_from(text_of(file_.bytes(block.at, block.size))));
            } catch (const Error& error) {
                add_damage(block.at, error.what());
            }
            return;
    }
}

void TakeReader::take_record(std::size_t rig, std::int64_t time_ms, const Block& block) {
    try {
        if (block.size > most_text_bytes) fail("a frame's record is too long");
        const FrameRecord record = frame_record_from(text_of(file_.bytes(block.at, block.size)));
        if (time_ms != facts_.time_ms_of(record))
            fail("the frame of pulse {} is at another time than its record states", record.pulse);
        frames_[rig].push_back({record.pulse,
                                record.gap,
                                record.dropped,
                                record.session,
                                record.exposure,
                                time_ms,
                                block,
                                {},
                                {},
                                record.colour_crc,
                                record.depth_crc,
                                record.rig,
                                record.link});
    } catch (const Error& error) {
        add_damage(block.at, fmt::format("rig {}: {}", facts_.rigs[rig].name, error.what()));
    }
}

void TakeReader::take_sound_record(std::int64_t time_ms, const Block& block) {
    try {
        if (block.size > most_text_bytes) fail("a sound's record is too long");
        const SoundRecord record = sound_record_from(text_of(file_.bytes(block.at, block.size)));
        if (time_ms != facts_.time_ms_of(time_of_sound(record.first)))
            fail("sound is at another time than its record states");
        sounds_.push_back({record.first, record.count, block, {}, record.crc});
    } catch (const Error& error) {
        add_damage(block.at, error.what());
    }
}

void TakeReader::take_sound(std::uint64_t at, std::int64_t time_ms, const Block& block) {
    // Its record precedes it.
    if (sounds_.empty() || sounds_.back().samples.size != 0 ||
        facts_.time_ms_of(time_of_sound(sounds_.back().first)) != time_ms ||
        block.size != sounds_.back().count * stored_sound_bytes)
        add_damage(at, "sound has no record");
    else
        sounds_.back().samples = block;
}

void TakeReader::sort_sounds() {
    std::erase_if(sounds_, [&](const Sound& sound) {
        if (sound.samples.size == 0)
            add_damage(sound.record.at, "the sound of a record is missing");
        return sound.samples.size == 0;
    });
    std::stable_sort(sounds_.begin(), sounds_.end(),
                     [](const Sound& a, const Sound& b) { return a.first < b.first; });
    std::int64_t end = 0;
    std::erase_if(sounds_, [&](const Sound& sound) {
        const bool is_twice = sound.first < end;
        if (is_twice) add_damage(sound.record.at, "sound occurs twice");
        end = std::max(end, sound.end());
        return is_twice;
    });
}

void TakeReader::sort_frames() {
    const auto by_pulse = [](const Frame& a, const Frame& b) { return a.pulse < b.pulse; };
    for (std::size_t rig = 0; rig < frames_.size(); ++rig) {
        std::vector<Frame>& frames = frames_[rig];
        const std::uint64_t last_at = frames.empty() ? 0 : frames.back().record.at;
        std::erase_if(frames, [&](const Frame& frame) {
            const bool is_whole = frame.colour_crc.has_value() == (frame.colour.size != 0) &&
                                  frame.depth_crc.has_value() == (frame.depth.size != 0);
            const bool is_last = frame.record.at == last_at;
            if (!is_whole)
                add_damage(frame.record.at,
                           !is_ended_ && is_last
                               ? fmt::format("images of pulse {} of rig {} are truncated",
                                             frame.pulse, facts_.rigs[rig].name)
                               : fmt::format("rig {} lacks images of pulse {}",
                                             facts_.rigs[rig].name, frame.pulse));
            return !is_whole;
        });
        std::stable_sort(frames.begin(), frames.end(), by_pulse);
        const auto twice =
            std::unique(frames.begin(), frames.end(),
                        [](const Frame& a, const Frame& b) { return a.pulse == b.pulse; });
        for (auto frame = twice; frame != frames.end(); ++frame)
            add_damage(frame->record.at,
                       fmt::format("rig {} has a pulse twice", facts_.rigs[rig].name));
        frames.erase(twice, frames.end());
    }
}

double TakeReader::duration_s() const {
    std::optional<std::int64_t> first, last;
    for (const std::vector<Frame>& frames : frames_) {
        if (frames.empty()) continue;
        first = std::min(first.value_or(frames.front().time_ms), frames.front().time_ms);
        last = std::max(last.value_or(frames.back().time_ms), frames.back().time_ms);
    }
    return first ? static_cast<double>(*last - *first) / 1000 : 0;
}

std::vector<std::byte> TakeReader::load(const Sound& sound) const {
    std::vector<std::byte> bytes = file_.bytes(sound.samples.at, sound.samples.size);
    if (crc32(bytes) != sound.crc)
        throw TakeDamaged(
            fmt::format("{}: sound at byte {} is damaged", path_.string(), sound.samples.at));
    return bytes;
}

StoredFrame TakeReader::load(std::size_t rig, const Frame& frame) const {
    const auto damaged = [&](const std::string& what, std::uint64_t at) {
        throw TakeDamaged(fmt::format("{}: rig {}'s {} of pulse {}, at byte {}, is damaged",
                                      path_.string(), facts_.rigs[rig].name, what, frame.pulse,
                                      at));
    };
    StoredFrame stored;
    try {
        stored.record = frame_record_from(text_of(file_.bytes(frame.record.at, frame.record.size)));
    } catch (const Error&) {
        damaged("record", frame.record.at);
    }
    const auto load_block = [&](const Block& block, const std::optional<std::uint32_t>& crc,
                                const char* what) {
        if (!crc) return std::vector<std::byte>();
        std::vector<std::byte> bytes = file_.bytes(block.at, block.size);
        if (crc32(bytes) != *crc) damaged(what, block.at);
        return bytes;
    };
    stored.colour = load_block(frame.colour, frame.colour_crc, "colour");
    stored.depth = load_block(frame.depth, frame.depth_crc, "disparity");
    return stored;
}

}  // namespace vantage
