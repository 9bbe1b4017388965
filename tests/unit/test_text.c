/*
   Unit test of base/text.h: what has no room is an error in text that programs read, and shows in words. Breaks where a
   piece is cut in silence, or where the last character has no place for the end of the text.
*/
#include "base/text.h"
#include "check.h"
#include "petscmain.h"
#include "scratch.h"

static PetscErrorCode Tests(PetscMPIInt size, int *failed)
{
  char           text[8] = "abc", words[8] = "", full[8] = "";
  Scratch        scratch;
  PetscErrorCode error;

  PetscFunctionBeginUser;
  (void)size;
  PetscCall(TextAdd(text, "defg", sizeof(text)));
  *failed += CheckTrue("a text that just fits", !strcmp(text, "abcdefg"), (double)strlen(text));
  PetscCall(ScratchCreate(&scratch));
  error = TextAdd(text, "h", sizeof(text));
  *failed += CheckTrue("one character more is an error", error == PETSC_ERR_USER_INPUT, error);
  *failed += CheckTrue("which names both", strstr(scratch.message, "'h'") && strstr(scratch.message, "'abcdefg'"), 0);
  *failed += CheckTrue("and leaves the text", !strcmp(text, "abcdefg"), 0);
  *failed += CheckTrue("scratch folder is empty", ScratchDestroy(&scratch), 0);
  PetscCall(WordsAdd(full, "abcdefg", sizeof(full)));
  *failed += CheckTrue("words that just fit", !strcmp(full, "abcdefg"), 0);
  PetscCall(WordsAdd(words, "abc, ", sizeof(words)));
  PetscCall(WordsAdd(words, "defgh", sizeof(words)));
  *failed += CheckTrue("words that do not end with ...", !strcmp(words, "abc,..."), 0);
  PetscCall(WordsAdd(words, "more", sizeof(words)));
  *failed += CheckTrue("and stay as they are", !strcmp(words, "abc,..."), 0);
  PetscFunctionReturn(0);
}

int main(int argc, char **argv)
{
  return PetscMain(argc, argv, Tests);
}
