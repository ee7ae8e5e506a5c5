/* Counts the calls of the system by which a program changes files in one folder, lets one of them fail, or records them.
 *
 * FAULTS_FOLDER: calls on what lies in it count. FAULTS_COUNT: a file that gets their number at the end, one line.
 * FAULTS_AT: the number of the call that fails, from 1 on. FAULTS_KIND: kill, eio, enospc, eintr or term; a call that fails
 * with eintr succeeds when it is made again, the others go on failing with every later write; term: the signal comes with the
 * call, which succeeds.
 *
 * FAULTS_DELAY: so many milliseconds pass before what lies in the folder is read, once the file FAULTS_DELAY_ONCE is there.
 *
 * FAULTS_TRACE: a file that gets every such call that succeeded, in their order, as tests/files/crash/trace.rs reads them.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

static atomic_long calls;
static int trace = -1;
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;
static char folder[4096];
static long at;
static long delay;
static const char *delay_once;
static const char *kind = "";

__attribute__((constructor)) static void begin(void) {
    const char *given = getenv("FAULTS_FOLDER");
    if (given) snprintf(folder, sizeof folder, "%s", given);
    const char *number = getenv("FAULTS_AT");
    at = number ? atol(number) : 0;
    const char *what = getenv("FAULTS_KIND");
    if (what) kind = what;
    const char *wait = getenv("FAULTS_DELAY");
    delay = wait ? atol(wait) : 0;
    delay_once = getenv("FAULTS_DELAY_ONCE");
    const char *record = getenv("FAULTS_TRACE");
    if (record) trace = open(record, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
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
    if (strcmp(kind, "term") == 0) {
        if (number == at) raise(SIGTERM);
        return 0;
    }
    if (strcmp(kind, "eintr") == 0) {
        errno = EINTR;
        return number == at;
    }
    errno = strcmp(kind, "enospc") == 0 ? ENOSPC : EIO;
    return strcmp(kind, "eio") == 0 ? number == at : 1;
}

enum { CREATE = 1, WRITE, TRUNCATE, SYNC, RENAME, UNLINK, RMDIR, MKDIR };

static void all(const void *from, size_t n) {
    const char *next = from;
    while (n > 0) {
        ssize_t done = write(trace, next, n);
        /* A trace with a hole is worse than none. */
        if (done < 0) abort();
        next += done;
        n -= done;
    }
}

/* One record: six numbers, two names, the bytes that were written. */
static void record(uint64_t what, uint64_t inode, uint64_t at, const char *name, const char *other, const void *from, size_t n) {
    int before = errno;
    uint64_t head[6] = {what, inode, at, name ? strlen(name) : 0, other ? strlen(other) : 0, n};
    pthread_mutex_lock(&turn);
    all(head, sizeof head);
    all(name, head[3]);
    all(other, head[4]);
    all(from, n);
    pthread_mutex_unlock(&turn);
    errno = before;
}

static uint64_t inode_of(int fd) {
    struct stat found;
    return fstat(fd, &found) == 0 ? found.st_ino : 0;
}

static int records(int inside) {
    return trace >= 0 && inside;
}

#define REAL(name) \
    static __typeof__(&name) real; \
    if (!real) real = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

/* A call on an open file; `told` records it once it has succeeded. */
#define WITH_FD(type, name, parameters, arguments, told) \
    type name parameters { \
        REAL(name); \
        int inside = is_inside_fd(fd); \
        if (fails(inside)) return -1; \
        type done = real arguments; \
        if (done >= 0 && records(inside)) told; \
        return done; \
    }
#define WRITTEN(place) record(WRITE, inode_of(fd), place, NULL, NULL, from, done)
#define CUT record(TRUNCATE, inode_of(fd), n, NULL, NULL, NULL, 0)
#define SYNCED record(SYNC, inode_of(fd), 0, NULL, NULL, NULL, 0)

WITH_FD(ssize_t, write, (int fd, const void *from, size_t n), (fd, from, n), WRITTEN(lseek(fd, 0, SEEK_CUR) - done))
WITH_FD(ssize_t, pwrite, (int fd, const void *from, size_t n, off_t to), (fd, from, n, to), WRITTEN(to))
WITH_FD(ssize_t, pwrite64, (int fd, const void *from, size_t n, off64_t to), (fd, from, n, to), WRITTEN(to))
WITH_FD(int, fsync, (int fd), (fd), SYNCED)
WITH_FD(int, fdatasync, (int fd), (fd), SYNCED)
WITH_FD(int, ftruncate, (int fd, off_t n), (fd, n), CUT)
WITH_FD(int, ftruncate64, (int fd, off64_t n), (fd, n), CUT)

static void late(int fd) {
    if (delay && is_inside_fd(fd) && access(delay_once, F_OK) == 0) usleep(1000 * delay);
}

#define READING(name, parameters, arguments) \
    ssize_t name parameters { \
        REAL(name); \
        late(fd); \
        return real arguments; \
    }
READING(read, (int fd, void *to, size_t n), (fd, to, n))
READING(pread, (int fd, void *to, size_t n, off_t from), (fd, to, n, from))
READING(pread64, (int fd, void *to, size_t n, off64_t from), (fd, to, n, from))

/* A room that is full can still be emptied: what removes fails only by eio, eintr and kill. */
static int fails_to_remove(int inside) {
    return strcmp(kind, "enospc") == 0 ? (inside && (atomic_fetch_add(&calls, 1), 0)) : fails(inside);
}

static int told(int done, uint64_t what, const char *name, const char *other) {
    struct stat found = {0};
    if (done == 0 && records(is_inside(other ? other : name))) {
        if (what == MKDIR) stat(name, &found);
        record(what, found.st_ino, 0, name, other, NULL, 0);
    }
    return done;
}

int rename(const char *from, const char *to) {
    REAL(rename);
    if (fails_to_remove(is_inside(to))) return -1;
    return told(real(from, to), RENAME, from, to);
}
int unlink(const char *path) {
    REAL(unlink);
    if (fails_to_remove(is_inside(path))) return -1;
    return told(real(path), UNLINK, path, NULL);
}
int rmdir(const char *path) {
    REAL(rmdir);
    if (fails_to_remove(is_inside(path))) return -1;
    return told(real(path), RMDIR, path, NULL);
}
/* A second name of a file; losses of power are not recorded for it. */
int linkat(int from_fd, const char *from, int to_fd, const char *to, int flags) {
    REAL(linkat);
    if (fails(is_inside(to))) return -1;
    return real(from_fd, from, to_fd, to, flags);
}
int mkdir(const char *path, mode_t mode) {
    REAL(mkdir);
    if (fails(is_inside(path))) return -1;
    return told(real(path, mode), MKDIR, path, NULL);
}
int chmod(const char *path, mode_t mode) {
    REAL(chmod);
    if (fails(is_inside(path))) return -1;
    return real(path, mode);
}

#define WRITES (O_WRONLY | O_RDWR | O_CREAT | O_TRUNC)
static int opened(int fd, const char *path, int flags, int was_there) {
    if (fd < 0 || !(flags & WRITES) || !records(is_inside(path))) return fd;
    if (!was_there) record(CREATE, inode_of(fd), 0, path, NULL, NULL, 0);
    else if (flags & O_TRUNC) record(TRUNCATE, inode_of(fd), 0, NULL, NULL, NULL, 0);
    return fd;
}

#define OPEN(name) \
    int name(const char *path, int flags, ...) { \
        REAL(name); \
        va_list rest; \
        va_start(rest, flags); \
        mode_t mode = va_arg(rest, mode_t); \
        va_end(rest); \
        if ((flags & WRITES) && fails(is_inside(path))) return -1; \
        int was_there = trace < 0 || access(path, F_OK) == 0; \
        return opened(real(path, flags, mode), path, flags, was_there); \
    }
OPEN(open)
OPEN(open64)
