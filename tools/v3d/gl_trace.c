// LD_PRELOAD library for tools/v3d.sh: writes to stderr which GL programs are linked and run, in between the lines that
// Mesa's V3D_DEBUG=shaderdb,qpu writes there, with the process's CPU time. A program is named by the shader file that
// ShaderLibrary writes into the second line of a source, and by its definitions.
//   TRACE link PROGRAM FILE[+FILE] DEFINE=VALUE...
//   TRACE run PROGRAM GROUPS_X GROUPS_Y GROUPS_Z WIDTH HEIGHT     (before; a drawing has 0 groups)
//   TRACE cpu PROGRAM MS                                          (spent in a link or a run of the program)
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { most_names = 8192 };
typedef struct { char *file, *defines; } Source;
static Source sources[most_names];
static unsigned attached[most_names][2];
static unsigned current;
static int viewport[2];

static double cpu_ms(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec * 1e3 + t.tv_nsec * 1e-6;
}

#define REAL(result, name, ...)          \
    static result (*real)(__VA_ARGS__);  \
    if (!real) real = dlsym(RTLD_NEXT, #name)

static void put_cpu(unsigned program, double since) {
    fprintf(stderr, "TRACE cpu %u %.1f\n", program, cpu_ms() - since);
    fflush(stderr);
}

void glShaderSource(unsigned shader, int count, const char *const *text, const int *lengths) {
    REAL(void, glShaderSource, unsigned, int, const char *const *, const int *);
    real(shader, count, text, lengths);
    if (shader >= most_names || count != 1) return;
    char *copy = strdup(text[0]), *rest = copy, *line, defines[4096] = "";
    Source source = {NULL, NULL};
    while ((line = strsep(&rest, "\n")) && strncmp(line, "#line", 5) != 0) {
        char name[128], value[128] = "";
        if (strncmp(line, "// shader ", 10) == 0 && !source.file) source.file = strdup(line + 10);
        if (sscanf(line, "#define %127s %127s", name, value) < 1) continue;
        const size_t used = strlen(defines);
        snprintf(defines + used, sizeof defines - used, " %s=%s", name, value);
    }
    free(copy);
    source.defines = strdup(defines);
    sources[shader] = source;
}

void glAttachShader(unsigned program, unsigned shader) {
    REAL(void, glAttachShader, unsigned, unsigned);
    real(program, shader);
    if (program >= most_names || shader >= most_names) return;
    attached[program][attached[program][0] ? 1 : 0] = shader;
}

void glLinkProgram(unsigned program) {
    REAL(void, glLinkProgram, unsigned);
    const unsigned *of = attached[program < most_names ? program : 0];
    // The last one attached is the fragment shader, or the only one.
    const Source *source = &sources[of[1] ? of[1] : of[0]];
    fprintf(stderr, "TRACE link %u %s%s\n", program, source->file ? source->file : "?", source->defines ? source->defines : "");
    fflush(stderr);
    const double before = cpu_ms();
    real(program);
    put_cpu(program, before);
}

void glUseProgram(unsigned program) {
    REAL(void, glUseProgram, unsigned);
    current = program;
    real(program);
}

void glViewport(int x, int y, int width, int height) {
    REAL(void, glViewport, int, int, int, int);
    viewport[0] = width, viewport[1] = height;
    real(x, y, width, height);
}

void glDispatchCompute(unsigned x, unsigned y, unsigned z) {
    REAL(void, glDispatchCompute, unsigned, unsigned, unsigned);
    fprintf(stderr, "TRACE run %u %u %u %u 0 0\n", current, x, y, z);
    fflush(stderr);
    const double before = cpu_ms();
    real(x, y, z);
    put_cpu(current, before);
}

void glDrawArrays(unsigned mode, int first, int count) {
    REAL(void, glDrawArrays, unsigned, int, int);
    fprintf(stderr, "TRACE run %u 0 0 0 %d %d\n", current, viewport[0], viewport[1]);
    fflush(stderr);
    const double before = cpu_ms();
    real(mode, first, count);
    put_cpu(current, before);
}
