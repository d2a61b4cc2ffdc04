#pragma once

#include <memory>
#include <mutex>
#include <vector>

namespace vantage {

/// Objects that take long to make (textures, buffers): one that nobody holds any more is handed out
/// again, as it is. Objects come back from any thread; they are made and destroyed by whoever owns
/// the pool, which must outlive all but the last of them.
template <class T>
class RecyclePool {
  public:
    /// `arguments`: of one that has to be made.
    template <class... Arguments>
    std::shared_ptr<T> take(const Arguments&... arguments) {
        std::unique_ptr<T> one;
        {
            const std::lock_guard lock(shelf_->mutex);
            if (!shelf_->free.empty()) {
                one = std::move(shelf_->free.back());
                shelf_->free.pop_back();
            }
        }
        if (!one) one = std::make_unique<T>(arguments...);
        return {one.release(), [shelf = std::weak_ptr(shelf_)](T* back) {
                    std::unique_ptr<T> owned(back);
                    const std::shared_ptr<Shelf> there = shelf.lock();
                    if (!there) return;
                    const std::lock_guard lock(there->mutex);
                    there->free.push_back(std::move(owned));
                }};
    }

  private:
    struct Shelf {
        std::mutex mutex;
        std::vector<std::unique_ptr<T>> free;
    };
    std::shared_ptr<Shelf> shelf_ = std::make_shared<Shelf>();
};

}  // namespace vantage
