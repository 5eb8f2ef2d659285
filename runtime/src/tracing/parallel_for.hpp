#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace idim {

/// Calls work(i) for i in 0..count-1 on all cores; the first exception thrown is thrown again when all have ended.
template <class Work>
void parallel_for(std::size_t count, const Work& work) {
    const std::size_t threads = std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), count);
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex guard;
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                const std::lock_guard<std::mutex> lock(guard);
                failure = failure ? failure : std::current_exception();
            }
        }
    };
    std::vector<std::thread> others;
    for (std::size_t k = 1; k < threads; ++k) {
        others.emplace_back(run);
    }
    run();
    for (std::thread& other : others) {
        other.join();
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
}

}  // namespace idim
