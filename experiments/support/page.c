#include "support/page.h"

#include <stdarg.h>
#include <stdio.h>

sl_status exp_page_open(exp_run *run, const char *folder, const char *heading, exp_page *page)
{
    char path[EXP_PATH];
    *page = (exp_page){.folder = folder};
    sl_status status = exp_path(run, "section.html", path);
    if (status == SL_OK) {
        status = sl_writer_create(path, &page->writer, &run->diag);
    }
    if (status == SL_OK) {
        exp_page_html(page, "<section id=\"%s\">\n<h2>%s</h2>\n", folder, heading);
    }
    return status;
}

sl_status exp_page_close(exp_run *run, exp_page *page)
{
    exp_page_html(page, "</section>\n");
    const sl_status status = sl_writer_commit(page->writer, &run->diag);
    page->writer = NULL;
    return status;
}

void exp_page_abandon(exp_page *page)
{
    sl_writer_abandon(page->writer);
    page->writer = NULL;
}

static void write_formatted(exp_page *page, const char *format, va_list args)
{
    char text[4096];
    const int length = vsnprintf(text, sizeof text, format, args);
    SL_ASSERT(length >= 0 && length < (int)sizeof text); /* texts are ours: none is cut short */
    (void)length;
    sl_writer_text(page->writer, text);
}

void exp_page_html(exp_page *page, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    write_formatted(page, format, args);
    va_end(args);
}

void exp_page_text(exp_page *page, const char *text)
{
    for (; *text != '\0'; text++) {
        switch (*text) {
        case '<':
            sl_writer_text(page->writer, "&lt;");
            break;
        case '>':
            sl_writer_text(page->writer, "&gt;");
            break;
        case '&':
            sl_writer_text(page->writer, "&amp;");
            break;
        default:
            sl_writer_bytes(page->writer, text, 1);
        }
    }
}

void exp_page_figure(exp_page *page, const char *class_name, const char *file, const char *alt, const char *caption)
{
    exp_page_html(page, "<figure class=\"%s\"><img loading=\"lazy\" src=\"%s/%s\" alt=\"", class_name, page->folder,
                  file);
    exp_page_text(page, alt);
    exp_page_html(page, "\"><figcaption>%s</figcaption></figure>\n", caption);
}

void exp_page_table_begin(exp_page *page, const char *header)
{
    exp_page_html(page, "<div class=\"scroll\"><table>\n<tr><th>");
    for (; *header != '\0'; header++) {
        if (*header == '|') {
            exp_page_html(page, "</th><th>");
        } else {
            sl_writer_bytes(page->writer, header, 1);
        }
    }
    exp_page_html(page, "</th></tr>\n");
}

void exp_page_row_begin(exp_page *page, bool bad)
{
    exp_page_html(page, bad ? "<tr class=\"bad\">" : "<tr>");
}

void exp_page_cell(exp_page *page, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    sl_writer_text(page->writer, "<td>");
    write_formatted(page, format, args);
    sl_writer_text(page->writer, "</td>");
    va_end(args);
}

void exp_page_time(exp_page *page, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    sl_writer_text(page->writer, "<td class=\"time\">");
    write_formatted(page, format, args);
    sl_writer_text(page->writer, "</td>");
    va_end(args);
}

void exp_page_row_end(exp_page *page)
{
    exp_page_html(page, "</tr>\n");
}

void exp_page_table_end(exp_page *page)
{
    exp_page_html(page, "</table></div>\n");
}
