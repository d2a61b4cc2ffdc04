#include "common/image/picture_pool.h"

#include <mutex>
#include <utility>
#include <vector>

namespace vantage {
namespace {

/// More are held at once by queues alone, which are emptied.
constexpr std::size_t most_kept = 16;

}  // namespace

/// What OpenCV counts references of is lent: the last of them gives it back.
class PicturePool::Shelf final : public cv::MatAllocator,
                                 public std::enable_shared_from_this<Shelf> {
  public:
    cv::UMatData* allocate(int dims, const int* sizes, int type, void*, std::size_t* step,
                           cv::AccessFlag, cv::UMatUsageFlags) const override {
        CV_Assert(dims == 2);
        auto lent =
            std::make_unique<Lent>(Lent{shared_from_this(), take({sizes[1], sizes[0]}, type)});
        auto data = std::make_unique<cv::UMatData>(this);
        step[1] = lent->memory.elemSize();
        step[0] = step[1] * static_cast<std::size_t>(sizes[1]);
        data->data = data->origdata = lent->memory.data;
        data->size = lent->memory.total() * step[1];
        data->userdata = lent.release();
        return data.release();
    }
    bool allocate(cv::UMatData*, cv::AccessFlag, cv::UMatUsageFlags) const override {
        return false;
    }
    void deallocate(cv::UMatData* data) const override {
        // It keeps the shelf until the end.
        const std::unique_ptr<Lent> lent(static_cast<Lent*>(data->userdata));
        delete data;
        put_back(lent->memory);
    }

  private:
    struct Lent {
        std::shared_ptr<const Shelf> shelf;
        cv::Mat memory;
    };

    cv::Mat take(cv::Size size, int type) const {
        {
            const std::lock_guard lock(mutex_);
            if (size != size_ || type != type_) free_.clear();
            size_ = size;
            type_ = type;
            if (!free_.empty()) {
                cv::Mat memory = std::move(free_.back());
                free_.pop_back();
                return memory;
            }
        }
        return cv::Mat(size, type);
    }
    void put_back(const cv::Mat& memory) const {
        const std::lock_guard lock(mutex_);
        if (memory.size() == size_ && memory.type() == type_ && free_.size() < most_kept)
            free_.push_back(memory);
    }

    mutable std::mutex mutex_;
    mutable cv::Size size_;
    mutable int type_ = 0;
    mutable std::vector<cv::Mat> free_;
};

PicturePool::PicturePool() : shelf_(std::make_shared<Shelf>()) {}

PicturePool::~PicturePool() = default;

cv::Mat PicturePool::take(cv::Size size, int type) {
    cv::Mat picture;
    picture.allocator = shelf_.get();
    picture.create(size, type);
    // Whoever gives it another size later does so without the pool, which may have gone.
    picture.allocator = nullptr;
    return picture;
}

}  // namespace vantage
