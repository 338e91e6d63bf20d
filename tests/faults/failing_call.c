/* Library for `tests/io_faults.rs`, loaded before that of C: one call of a function of the system fails.
 *
 * FAULT is "NAME NUMBER ERROR MODE": the calls of NAME are counted from 1; number NUMBER fails with the error number ERROR, alone
 * with MODE 0, and with all that follow with MODE 1. With MODE 2, which is for writes, it writes half of its bytes, and all that
 * follow fail. At the end of the process the number of calls is written to the file FAULT_COUNT. Calls that concern the
 * terminal, such as messages, or the files in which the kernel describes itself, neither count nor fail. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { ALONE, FOLLOWED, HALF };

static char name[32];
static int number, error, mode;
static atomic_int count;

__attribute__((constructor)) static void read_fault(void)
{
    const char *fault = getenv("FAULT");
    if (!fault || sscanf(fault, "%31s %d %d %d", name, &number, &error, &mode) != 4) {
        name[0] = 0;
    }
}

__attribute__((destructor)) static void write_count(void)
{
    const char *path = getenv("FAULT_COUNT");
    if (path) {
        char text[32];
        const int length = snprintf(text, sizeof text, "%d", atomic_load(&count));
        const long file = syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
        syscall(SYS_write, file, text, (size_t)length);
        syscall(SYS_close, file);
    }
}

/* Counts a call, and returns true if it fails; `*half` is set where it does half of its work. */
static int fails(const char *called, int *half)
{
    if (strcmp(called, name) != 0) {
        return 0;
    }
    const int now = atomic_fetch_add(&count, 1) + 1;
    if (half) {
        *half = mode == HALF && now == number;
    }
    if (now == number || (mode != ALONE && number > 0 && now > number)) {
        errno = error;
        return 1;
    }
    return 0;
}

static int is_of_kernel(const char *path)
{
    return strncmp(path, "/proc/", 6) == 0 || strncmp(path, "/sys/", 5) == 0;
}

static int is_file(int file)
{
    char link[32], path[16] = "";
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    return file > 2 && readlink(link, path, sizeof path - 1) > 0 && !is_of_kernel(path);
}

#define REAL(result, called, ...) \
    static result (*real)(__VA_ARGS__); \
    if (!real) { \
        *(void **)&real = dlsym(RTLD_NEXT, called); \
    }

ssize_t write(int file, const void *data, size_t size)
{
    REAL(ssize_t, "write", int, const void *, size_t)
    int half = 0;
    if (is_file(file) && fails("write", &half)) {
        return half && size > 1 ? real(file, data, size / 2) : -1;
    }
    return real(file, data, size);
}

ssize_t read(int file, void *data, size_t size)
{
    REAL(ssize_t, "read", int, void *, size_t)
    return is_file(file) && fails("read", NULL) ? -1 : real(file, data, size);
}

int fsync(int file)
{
    REAL(int, "fsync", int)
    return fails("fsync", NULL) ? -1 : real(file);
}

int fdatasync(int file)
{
    REAL(int, "fdatasync", int)
    return fails("fsync", NULL) ? -1 : real(file);
}

int rename(const char *from, const char *to)
{
    REAL(int, "rename", const char *, const char *)
    return fails("rename", NULL) ? -1 : real(from, to);
}

int unlink(const char *path)
{
    REAL(int, "unlink", const char *)
    return fails("unlink", NULL) ? -1 : real(path);
}

int mkdir(const char *path, mode_t permissions)
{
    REAL(int, "mkdir", const char *, mode_t)
    return fails("mkdir", NULL) ? -1 : real(path, permissions);
}

int flock(int file, int operation)
{
    REAL(int, "flock", int, int)
    return fails("flock", NULL) ? -1 : real(file, operation);
}

off64_t lseek64(int file, off64_t offset, int from)
{
    REAL(off64_t, "lseek64", int, off64_t, int)
    return fails("lseek", NULL) ? -1 : real(file, offset, from);
}

int open64(const char *path, int flags, ...)
{
    REAL(int, "open64", const char *, int, ...)
    va_list more;
    va_start(more, flags);
    const mode_t permissions = (flags & O_CREAT) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return !is_of_kernel(path) && fails("open", NULL) ? -1 : real(path, flags, permissions);
}

int statx(int directory, const char *path, int flags, unsigned mask, struct statx *status)
{
    REAL(int, "statx", int, const char *, int, unsigned, struct statx *)
    return fails("statx", NULL) ? -1 : real(directory, path, flags, mask, status);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument)
{
    REAL(int, "pthread_create", pthread_t *, const pthread_attr_t *, void *(*)(void *), void *)
    return fails("pthread_create", NULL) ? error : real(thread, attributes, start, argument);
}
