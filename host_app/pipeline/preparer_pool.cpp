#include "host_app/pipeline/preparer_pool.h"

#include <utility>

namespace vantage {

ContextGroup::Member PreparerPool::join(const std::string& failed_synthesiser) {
    if (generation() != contexts_->generation())
        generations_.push_back({contexts_->join(), {}, {}});
    else if (auto failed = generations_.back().preparers.extract(failed_synthesiser))
        generations_.back().retired.push_back(std::move(failed.mapped()));
    return generations_.back().member;
}

std::shared_ptr<InstantPreparer> PreparerPool::preparer_of(const std::string& synthesiser,
                                                           const MakePreparer& make,
                                                           const ShaderLibrary& shaders) {
    auto& known = generations_.back().preparers;
    if (const auto at = known.find(synthesiser); at != known.end()) return at->second;
    std::shared_ptr<InstantPreparer> preparer = make(shaders);
    if (BackgroundAccess* access = preparer->background_access()) access->begin_with(background_);
    return known[synthesiser] = std::move(preparer);
}

void PreparerPool::learn_background_anew() {
    background_ = nullptr;
    for (const auto& [synthesiser, preparer] : generations_.back().preparers)
        if (BackgroundAccess* access = preparer->background_access()) access->learn_anew();
}

void PreparerPool::release_unused() {
    const auto release = [](Generation& one) {
        std::erase_if(one.retired, [](const auto& each) { return each.use_count() == 1; });
    };
    release(generations_.back());
    if (generations_.size() == 1) return;
    const CurrentContext none{CurrentContext::None{}};
    for (auto one = generations_.begin(); one != generations_.end() - 1; ++one) {
        for (auto& [synthesiser, preparer] : std::exchange(one->preparers, {}))
            one->retired.push_back(std::move(preparer));
        release(*one);
    }
    std::erase_if(generations_, [&](const Generation& one) {
        return one.retired.empty() && &one != &generations_.back();
    });
}

void PreparerPool::clear() {
    generations_.back().preparers.clear();
    generations_.back().retired.clear();
    // Objects of lost contexts are destroyed without a current context.
    const CurrentContext none{CurrentContext::None{}};
    generations_.clear();
}

}  // namespace vantage
