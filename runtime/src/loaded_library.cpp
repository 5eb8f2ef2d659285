#include "loaded_library.hpp"

#include <dlfcn.h>

#include <stdexcept>

#include "file_descriptor.hpp"

namespace idim {

namespace {

std::string path_of(int number) {
    return "/proc/self/fd/" + std::to_string(number);
}

/// The loader knows a library by its path and would give this one for the next file of the same number. So the number
/// stays taken where the library outlives its handle, as one linked with -z nodelete does.
void unload(void* handle, int number) {
    file_descriptor file(number);
    dlclose(handle);
    if (void* const resident = dlopen(path_of(number).c_str(), RTLD_NOW | RTLD_NOLOAD)) {
        dlclose(resident);
        file.release();
    }
}

}  // namespace

std::shared_ptr<void> load_library(const std::string& bytes) {
    file_descriptor file = memory_file();
    write_all(file, bytes);
    void* const handle = dlopen(path_of(file.number()).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* const message = dlerror();
        throw std::runtime_error(message == nullptr ? "the loader refuses it" : message);
    }
    const int number = file.release();
    return {handle, [number](void* library) { unload(library, number); }};
}

}  // namespace idim
