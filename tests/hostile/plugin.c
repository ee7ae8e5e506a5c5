/* A filter for HDF5 that leaves a mark where HOSTILE_MARK says when it is loaded. */
#include <stdio.h>
#include <stdlib.h>

typedef struct {
    int version;
    int id;
    unsigned encoder, decoder;
    const char *name;
    void *can_apply, *set_local;
    size_t (*filter)(unsigned, size_t, const unsigned *, size_t, size_t *, void **);
} filter_class;

static size_t pass(unsigned flags, size_t count, const unsigned *values, size_t bytes, size_t *size, void **buffer)
{
    return bytes;
}

static const filter_class hostile = {1, 32768 + 77, 1, 1, "hostile", NULL, NULL, pass};

__attribute__((constructor)) static void mark(void)
{
    const char *path = getenv("HOSTILE_MARK");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (file)
        fclose(file);
}

int H5PLget_plugin_type(void) { return 0; }
const void *H5PLget_plugin_info(void) { return &hostile; }
