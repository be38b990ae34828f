#pragma once
/// Parallel loops. A loop is cut into blocks of a fixed length, whatever the number of threads, so that a reduction
/// which adds its block sums in block order gives the same bits on any machine.

#include <cstddef>
#include <functional>

namespace sinew {

/// Threads that parallel loops use: the machine's cores, or the environment's SINEW_THREADS, or set_thread_count.
int thread_count();
void set_thread_count(int count);

/// Calls body(begin, end) for the blocks [0, block), [block, 2 block) ... of [0, n), each once, on any thread; returns
/// when all have run. An exception of a block is rethrown here (the one of the lowest block). A loop inside a loop runs
/// serially.
void parallel_for(std::size_t n, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace sinew
