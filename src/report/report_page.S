/* The page of the report, built by report/build.mjs, as bytes in the library. */
    .section .rodata
    .balign 16
    .global posewright_report_page
    .global posewright_report_page_end
posewright_report_page:
    .incbin POSEWRIGHT_REPORT_PAGE
posewright_report_page_end:
    .byte 0
    .section .note.GNU-stack,"",%progbits
