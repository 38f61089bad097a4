/* Factorizes and solves a symmetric positive definite system with CHOLMOD, one thread; started by
 * reference.py.
 *
 *   cholmod MATRIX SOLUTION
 *   cholmod MATRIX             only the flops of METIS_NodeND's ordering
 *
 * MATRIX: two int64, n and the number of entries; of the lower triangle by columns, starts and rows
 * in int32, values; the right-hand side. Prints seconds and memory as JSON. */
#define _GNU_SOURCE
#include <cholmod.h>
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

extern void dgemm_(void);

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void take(void *to, size_t size, size_t count, FILE *file)
{
    if (fread(to, size, count, file) != count) {
        fprintf(stderr, "cholmod: the matrix is truncated\n");
        exit(2);
    }
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 || argc == 3 ? fopen(argv[1], "rb") : NULL;
    if (!file) {
        fprintf(stderr, "usage: cholmod MATRIX [SOLUTION]\n");
        return 2;
    }
    cholmod_common common;
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;

    int64_t size[2];
    take(size, sizeof *size, 2, file);
    size_t n = (size_t)size[0], entries = (size_t)size[1];
    cholmod_sparse *K = cholmod_allocate_sparse(n, n, entries, 1, 1, -1, CHOLMOD_REAL, &common);
    cholmod_dense *f = cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &common);
    take(K->p, sizeof(int), n + 1, file);
    take(K->i, sizeof(int), entries, file);
    take(K->x, sizeof(double), entries, file);
    take(f->x, sizeof(double), n, file);
    fclose(file);

    if (argc == 2) {
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_METIS;
        cholmod_analyze(K, &common);
        printf("%.0f\n", common.fl);
        return common.status;
    }

    double start = now();
    cholmod_factor *L = cholmod_analyze(K, &common);
    double analysed = now();
    cholmod_factorize(K, L, &common);
    double factorized = now();
    cholmod_dense *u = cholmod_solve(CHOLMOD_A, L, f, &common);
    double end = now();
    if (!u || common.status != CHOLMOD_OK) {
        fprintf(stderr, "cholmod: status %d\n", common.status);
        return 1;
    }

    file = fopen(argv[2], "wb");
    if (!file || fwrite(u->x, sizeof(double), n, file) != n || fclose(file) != 0) {
        perror(argv[2]);
        return 1;
    }
    Dl_info blas = {0};
    dladdr((void *)(uintptr_t)dgemm_, &blas);
    printf("{\"symbolic\": %.6f, \"factor\": %.6f, \"solve\": %.6f, \"total\": %.6f, "
           "\"memory\": %zu, \"entries\": %.0f, \"flops\": %.0f, \"ordering\": \"%s\", "
           "\"version\": \"%d.%d.%d\", \"blas\": \"%s\"}\n",
           analysed - start, factorized - analysed, end - factorized, end - start,
           common.memory_usage, common.lnz, common.fl,
           common.method[common.selected].ordering == CHOLMOD_METIS ? "METIS" : "AMD",
           CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION,
           blas.dli_fname ? blas.dli_fname : "unknown");
    return 0;
}
