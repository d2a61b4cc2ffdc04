// QEMU plugin for tools/cores.sh: counts the instructions that a 64-bit ARM program executes, and prints them when it ends:
//   INSTRUCTIONS total, vector arithmetic, vector loads and stores, other loads and stores
// The few declarations of QEMU's plugin interface that it needs stand here, since Debian packages no header of them.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef PLUGIN_VERSION
#define PLUGIN_VERSION 1
#endif

typedef uint64_t PluginId;
typedef struct qemu_plugin_tb Block;
typedef struct qemu_plugin_insn Instruction;
enum { no_registers = 0 };

extern void qemu_plugin_register_vcpu_tb_trans_cb(PluginId, void (*)(PluginId, Block *));
extern void qemu_plugin_register_vcpu_tb_exec_cb(Block *, void (*)(unsigned, void *), int, void *);
extern void qemu_plugin_register_atexit_cb(PluginId, void (*)(PluginId, void *), void *);
extern size_t qemu_plugin_tb_n_insns(const Block *);
extern Instruction *qemu_plugin_tb_get_insn(const Block *, size_t);
extern void *qemu_plugin_insn_haddr(const Instruction *);
extern void qemu_plugin_outs(const char *);

__attribute__((visibility("default"))) int qemu_plugin_version = PLUGIN_VERSION;

typedef struct {
    uint64_t all, vector, vector_memory, memory;
} Counts;
static Counts total;

static void add(unsigned processor, void *of_block) {
    const Counts *more = of_block;
    (void)processor;
    total.all += more->all;
    total.vector += more->vector;
    total.vector_memory += more->vector_memory;
    total.memory += more->memory;
}

static void translate(PluginId id, Block *block) {
    Counts *counts = calloc(1, sizeof *counts);  // as long as the process: translated blocks stay
    (void)id;
    counts->all = qemu_plugin_tb_n_insns(block);
    for (size_t i = 0; i < counts->all; ++i) {
        uint32_t word;
        memcpy(&word, qemu_plugin_insn_haddr(qemu_plugin_tb_get_insn(block, i)), sizeof word);
        // Arm's manual, "A64 instruction set encoding": bits 28 to 25 are the group, and bit 26 of a load means a vector.
        const uint32_t group = (word >> 25) & 15;
        if ((group & 7) == 7) ++counts->vector;
        else if ((group & 5) == 4 && (word >> 26) & 1) ++counts->vector_memory;
        else if ((group & 5) == 4) ++counts->memory;
    }
    qemu_plugin_register_vcpu_tb_exec_cb(block, add, no_registers, counts);
}

static void print(PluginId id, void *unused) {
    char line[128];
    (void)id, (void)unused;
    snprintf(line, sizeof line, "INSTRUCTIONS %llu %llu %llu %llu\n", (unsigned long long)total.all,
             (unsigned long long)total.vector, (unsigned long long)total.vector_memory, (unsigned long long)total.memory);
    qemu_plugin_outs(line);
}

__attribute__((visibility("default"))) int qemu_plugin_install(PluginId id, const void *info, int count, char **arguments) {
    (void)info, (void)count, (void)arguments;
    qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
    qemu_plugin_register_atexit_cb(id, print, NULL);
    return 0;
}
