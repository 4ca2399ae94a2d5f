/* A C11 program as small as a user's: builds a TIN, or optimises one, of files, and writes it.
 * Usage: build_files OUTPUT POINTS NAME=VALUE...   or   build_files OUTPUT --tin=FILE NAME=VALUE... */
#include <thalweg/thalweg.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int fail(void) {
  fprintf(stderr, "%s: %s\n", thalweg_status_name(thalweg_last_status()), thalweg_last_message());
  return EXIT_FAILURE;
}

static thalweg_status set_option(thalweg_job* job, char* assignment) {
  char* equals = strchr(assignment, '=');
  if (equals == NULL) return thalweg_job_set_option(job, assignment, NULL);
  *equals = '\0';
  return thalweg_job_set_option(job, assignment, equals + 1);
}

int main(int argc, char** argv) {
  if (argc < 3) return EXIT_FAILURE;
  static const char prefix[] = "--tin=";
  const int exists = strncmp(argv[2], prefix, strlen(prefix)) == 0;
  thalweg_job* job = thalweg_job_new();
  if (!exists && thalweg_job_add_source(job, argv[2]) != THALWEG_OK) return fail();
  for (int i = 3; i < argc; ++i) {
    if (set_option(job, argv[i]) != THALWEG_OK) return fail();
  }
  thalweg_tin* tin = NULL;
  const thalweg_status status =
      exists ? thalweg_job_optimize(job, argv[2] + strlen(prefix), &tin) : thalweg_job_build(job, &tin);
  if (status != THALWEG_OK || thalweg_tin_write(tin, argv[1], NULL, NULL, 1) != THALWEG_OK) return fail();
  thalweg_tin_free(tin);
  thalweg_job_free(job);
  return EXIT_SUCCESS;
}
