/* Numbers of 64 bits are too many for a sweep. */
#include <stdio.h>
int main(void)
{
    printf("not swept: numbers of 64 bits\n");
    return 0;
}
