// SPDX-License-Identifier: MIT
#include "gpu/pipeline_compiler.h"

#include "gpu/frame_graph.h"

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

namespace gn {

struct PipelineCompiler::Impl {
    Device& device;
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<PipelineOrder> orders;  ///< the first one is being made
    std::vector<std::pair<PipelineOrder, Pipeline>> made;
    std::exception_ptr failure;
    bool ends = false;
    std::thread thread;

    /// What the thread does: one order after the other, until it is told to end.
    void work() {
        std::unique_lock lock(mutex);
        for (;;) {
            changed.wait(lock, [&] { return ends || !orders.empty(); });
            if (ends) {
                return;
            }
            const PipelineOrder order = orders.front();
            lock.unlock();
            std::exception_ptr failed;
            Pipeline pipeline;
            try {
                pipeline = device.pipelines().make(order);
            } catch (...) {
                failed = std::current_exception();
            }
            lock.lock();
            if (failed != nullptr) {
                failure = failed;
                orders.clear();
            } else {
                made.emplace_back(order, std::move(pipeline));
                orders.pop_front();
            }
        }
    }

    /// Hands what was made to the device. Under the lock.
    void deliver() {
        for (auto& [order, pipeline] : made) {
            device.pipelines().take(order, std::move(pipeline));
        }
        made.clear();
    }
};

PipelineCompiler::PipelineCompiler(Device& device) : impl_(new Impl{.device = device}) {}

PipelineCompiler::~PipelineCompiler() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->ends = true;
    }
    impl_->changed.notify_all();
    if (impl_->thread.joinable()) {
        impl_->thread.join();
    }
    impl_->deliver();
}

bool PipelineCompiler::busy() const {
    const std::lock_guard lock(impl_->mutex);
    return !impl_->orders.empty();
}

bool PipelineCompiler::ready(FrameGraph& graph) {
    const std::lock_guard lock(impl_->mutex);
    if (!impl_->orders.empty()) {
        return false;
    }
    impl_->deliver();
    if (impl_->failure != nullptr) {
        std::rethrow_exception(std::exchange(impl_->failure, nullptr));
    }
    std::vector<PipelineOrder> missing = graph.missing();
    if (missing.empty()) {
        return true;
    }
    impl_->orders.assign(std::make_move_iterator(missing.begin()), std::make_move_iterator(missing.end()));
    if (!impl_->thread.joinable()) {
        impl_->thread = std::thread([impl = impl_.get()] { impl->work(); });
    }
    impl_->changed.notify_all();
    return false;
}

}  // namespace gn
