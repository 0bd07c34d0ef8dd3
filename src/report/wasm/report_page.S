/* The page of the report, as in ../report_page.S, for the assembler of WebAssembly: each symbol has a type and a size. */
    .section .rodata.page,"",@
    .balign 16
    .global posewright_report_page
    .global posewright_report_page_end
    .type posewright_report_page,@object
    .type posewright_report_page_end,@object
posewright_report_page:
    .incbin POSEWRIGHT_REPORT_PAGE
    .size posewright_report_page, posewright_report_page_end - posewright_report_page
posewright_report_page_end:
    .byte 0
    .size posewright_report_page_end, 1
