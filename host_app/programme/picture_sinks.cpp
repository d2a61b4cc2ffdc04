#include "host_app/programme/picture_sinks.h"

#include <exception>
#include <utility>

#include "common/base/log.h"

namespace vantage {

void PictureSinks::add(std::unique_ptr<PictureSink> sink) {
    SinkState state;
    state.name = sink->name();
    sinks_.push_back({std::move(sink), std::move(state)});
    note();
}

void PictureSinks::give(const ProgrammePicture& picture) {
    for (Sink& sink : sinks_) {
        if (!sink.state.failure.empty()) continue;
        try {
            sink.sink->take(picture);
            ++sink.state.pictures;
        } catch (const std::exception& error) {
            sink.state.failure = error.what();
            log_error("{} failed and was closed; the programme goes on: {}", sink.state.name,
                      error.what());
        }
    }
    note();
}

void PictureSinks::finish() {
    for (Sink& sink : sinks_) {
        if (!sink.state.failure.empty()) continue;
        try {
            sink.sink->finish();
        } catch (const std::exception& error) {
            sink.state.failure = error.what();
            log_error("{}: {}", sink.state.name, error.what());
        }
    }
    note();
}

std::vector<SinkState> PictureSinks::states() const {
    const std::lock_guard lock(mutex_);
    return states_;
}

void PictureSinks::note() {
    const std::lock_guard lock(mutex_);
    states_.clear();
    for (const Sink& sink : sinks_)
        if (!sink.state.name.empty()) states_.push_back(sink.state);
}

}  // namespace vantage
