/* Counts the calls of the system by which a program changes files in one folder, and lets one of them fail.
 *
 * FAULTS_FOLDER: calls on what lies in it count. FAULTS_COUNT: a file that gets their number at the end, one line.
 * FAULTS_AT: the number of the call that fails, from 1 on. FAULTS_KIND: kill, eio, enospc or eintr; a call that fails
 * with eintr succeeds when it is made again, the others go on failing with every later write.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

static atomic_long calls;
static char folder[4096];
static long at;
static const char *kind = "";

__attribute__((constructor)) static void begin(void) {
    const char *given = getenv("FAULTS_FOLDER");
    if (given) snprintf(folder, sizeof folder, "%s", given);
    const char *number = getenv("FAULTS_AT");
    at = number ? atol(number) : 0;
    const char *what = getenv("FAULTS_KIND");
    if (what) kind = what;
}

__attribute__((destructor)) static void end(void) {
    const char *name = getenv("FAULTS_COUNT");
    FILE *file = name ? fopen(name, "w") : NULL;
    if (!file) return;
    fprintf(file, "%ld\n", atomic_load(&calls));
    fclose(file);
}

static int is_inside(const char *path) {
    if (!folder[0] || !path) return 0;
    /* Relative names: the program runs in the folder. */
    if (path[0] != '/') return 1;
    return strncmp(path, folder, strlen(folder)) == 0;
}

static int is_inside_fd(int fd) {
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    ssize_t n = readlink(link, path, sizeof path - 1);
    if (n <= 0) return 0;
    path[n] = 0;
    return path[0] == '/' && is_inside(path);
}

/* Whether this call fails; errno is set then. */
static int fails(int inside) {
    if (!inside) return 0;
    long number = atomic_fetch_add(&calls, 1) + 1;
    if (!at || number < at) return 0;
    if (number == at && strcmp(kind, "kill") == 0) raise(SIGKILL);
    if (strcmp(kind, "eintr") == 0) {
        errno = EINTR;
        return number == at;
    }
    errno = strcmp(kind, "enospc") == 0 ? ENOSPC : EIO;
    return strcmp(kind, "eio") == 0 ? number == at : 1;
}

#define REAL(name) \
    static __typeof__(&name) real; \
    if (!real) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

#define WITH_FD(type, name, parameters, arguments) \
    type name parameters { \
        REAL(name); \
        if (fails(is_inside_fd(fd))) return -1; \
        return real arguments; \
    }

WITH_FD(ssize_t, write, (int fd, const void *from, size_t n), (fd, from, n))
WITH_FD(ssize_t, pwrite, (int fd, const void *from, size_t n, off_t to), (fd, from, n, to))
WITH_FD(ssize_t, pwrite64, (int fd, const void *from, size_t n, off64_t to), (fd, from, n, to))
WITH_FD(int, fsync, (int fd), (fd))
WITH_FD(int, fdatasync, (int fd), (fd))
WITH_FD(int, ftruncate, (int fd, off_t n), (fd, n))
WITH_FD(int, ftruncate64, (int fd, off64_t n), (fd, n))

/* A room that is full can still be emptied: what removes fails only by eio, eintr and kill. */
static int fails_to_remove(int inside) {
    return strcmp(kind, "enospc") == 0 ? (inside && (atomic_fetch_add(&calls, 1), 0)) : fails(inside);
}

int rename(const char *from, const char *to) {
    REAL(rename);
    if (fails_to_remove(is_inside(to))) return -1;
    return real(from, to);
}
int unlink(const char *path) {
    REAL(unlink);
    if (fails_to_remove(is_inside(path))) return -1;
    return real(path);
}
int rmdir(const char *path) {
    REAL(rmdir);
    if (fails_to_remove(is_inside(path))) return -1;
    return real(path);
}
int mkdir(const char *path, mode_t mode) {
    REAL(mkdir);
    if (fails(is_inside(path))) return -1;
    return real(path, mode);
}
int chmod(const char *path, mode_t mode) {
    REAL(chmod);
    if (fails(is_inside(path))) return -1;
    return real(path, mode);
}

#define WRITES (O_WRONLY | O_RDWR | O_CREAT | O_TRUNC)
#define OPEN(name) \
    int name(const char *path, int flags, ...) { \
        REAL(name); \
        va_list rest; \
        va_start(rest, flags); \
        mode_t mode = va_arg(rest, mode_t); \
        va_end(rest); \
        if ((flags & WRITES) && fails(is_inside(path))) return -1; \
        return real(path, flags, mode); \
    }
OPEN(open)
OPEN(open64)
