!> Procedures of the C library that the program calls. Each has an interface of its own: where
!> several share an abstract one, gfortran (12) passes addresses in place of values, in some of the
!> modules that use them.
module c_library
    use, intrinsic :: iso_c_binding, only : c_char, c_double, c_funptr, c_int, c_int64_t, &
        c_intptr_t, c_long, c_ptr, c_size_t
    implicit none
    private

    public :: c_access, c_close, c_end, c_execv, c_exit, c_fclose, c_ferror, c_fflush, c_fopen, &
        c_fork, c_fread, c_fwrite, c_getpid, c_getppid, c_isatty, c_kill, c_madvise, c_mkdir, &
        c_pipe, c_poll, c_puts, c_read, c_realpath, c_remove, c_rename, c_signal, &
        c_strlen, c_strtod, c_truncate, c_wait, c_waitpid, c_write

    interface
        integer(c_int) function c_execv(path, arguments) bind(C, name='execv')
            import :: c_char, c_int, c_ptr
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            type(c_ptr), intent(in) :: arguments(*)
        end function c_execv

        !> `resolved` has room for PATH_MAX characters. The result is it, or null.
        type(c_ptr) function c_realpath(path, resolved) bind(C, name='realpath')
            import :: c_char, c_ptr
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            character(kind=c_char), intent(inout) :: resolved(*)
        end function c_realpath

        integer(c_int) function c_isatty(descriptor) bind(C, name='isatty')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: descriptor
        end function c_isatty

        !> Of memory from a page's start on.
        integer(c_int) function c_madvise(start, length, advice) bind(C, name='madvise')
            import :: c_int, c_intptr_t, c_size_t
            implicit none
            integer(c_intptr_t), value, intent(in) :: start
            integer(c_size_t), value, intent(in) :: length
            integer(c_int), value, intent(in) :: advice
        end function c_madvise

        integer(c_int) function c_mkdir(path, mode) bind(C, name='mkdir')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int), value, intent(in) :: mode
        end function c_mkdir

        integer(c_int) function c_access(path, mode) bind(C, name='access')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int), value, intent(in) :: mode
        end function c_access

        integer(c_int) function c_truncate(path, length) bind(C, name='truncate')
            import :: c_char, c_int, c_int64_t
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int64_t), value, intent(in) :: length
        end function c_truncate

        integer(c_int) function c_rename(old, new) bind(C, name='rename')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: old(*), new(*)
        end function c_rename

        integer(c_int) function c_remove(path) bind(C, name='remove')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: path(*)
        end function c_remove

        type(c_funptr) function c_signal(number, handler) bind(C, name='signal')
            import :: c_funptr, c_int
            implicit none
            integer(c_int), value, intent(in) :: number
            type(c_funptr), value, intent(in) :: handler
        end function c_signal

        integer(c_int) function c_puts(text) bind(C, name='puts')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: text(*)
        end function c_puts

        integer(c_int) function c_fflush(stream) bind(C, name='fflush')
            import :: c_int, c_ptr
            implicit none
            type(c_ptr), value, intent(in) :: stream
        end function c_fflush

        subroutine c_end(status) bind(C, name='_exit')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: status
        end subroutine c_end

        subroutine c_exit(status) bind(C, name='exit')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: status
        end subroutine c_exit

        integer(c_int) function c_fork() bind(C, name='fork')
            import :: c_int
            implicit none
        end function c_fork

        integer(c_int) function c_getpid() bind(C, name='getpid')
            import :: c_int
            implicit none
        end function c_getpid

        integer(c_int) function c_getppid() bind(C, name='getppid')
            import :: c_int
            implicit none
        end function c_getppid

        integer(c_int) function c_wait(status) bind(C, name='wait')
            import :: c_int
            implicit none
            integer(c_int), intent(out) :: status
        end function c_wait

        integer(c_int) function c_pipe(ends) bind(C, name='pipe')
            import :: c_int
            implicit none
            integer(c_int), intent(out) :: ends(2)
        end function c_pipe

        integer(c_int) function c_close(descriptor) bind(C, name='close')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: descriptor
        end function c_close

        !> The result is a ssize_t, as wide and signed here.
        integer(c_size_t) function c_read(descriptor, buffer, length) bind(C, name='read')
            import :: c_char, c_int, c_size_t
            implicit none
            integer(c_int), value, intent(in) :: descriptor
            character(kind=c_char), intent(inout) :: buffer(*)
            integer(c_size_t), value, intent(in) :: length
        end function c_read

        integer(c_size_t) function c_write(descriptor, text, length) bind(C, name='write')
            import :: c_char, c_int, c_size_t
            implicit none
            integer(c_int), value, intent(in) :: descriptor
            character(kind=c_char), intent(in) :: text(*)
            integer(c_size_t), value, intent(in) :: length
        end function c_write

        integer(c_int) function c_waitpid(id, status, options) bind(C, name='waitpid')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: id, options
            integer(c_int), intent(out) :: status
        end function c_waitpid

        integer(c_int) function c_kill(id, signal) bind(C, name='kill')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: id, signal
        end function c_kill

        integer(c_int) function c_poll(nothing, number, milliseconds) bind(C, name='poll')
            import :: c_int, c_long, c_ptr
            implicit none
            type(c_ptr), value, intent(in) :: nothing
            integer(c_long), value, intent(in) :: number
            integer(c_int), value, intent(in) :: milliseconds
        end function c_poll

        type(c_ptr) function c_fopen(name, mode) bind(C, name='fopen')
            import :: c_char, c_ptr
            implicit none
            character(kind=c_char), intent(in) :: name(*), mode(*)
        end function c_fopen

        integer(c_size_t) function c_fwrite(text, item_size, items, stream) bind(C, name='fwrite')
            import :: c_char, c_ptr, c_size_t
            implicit none
            character(kind=c_char), intent(in) :: text(*)
            integer(c_size_t), value, intent(in) :: item_size, items
            type(c_ptr), value, intent(in) :: stream
        end function c_fwrite

        integer(c_int) function c_fclose(stream) bind(C, name='fclose')
            import :: c_int, c_ptr
            implicit none
            type(c_ptr), value, intent(in) :: stream
        end function c_fclose

        integer(c_size_t) function c_fread(buffer, item_size, items, stream) bind(C, name='fread')
            import :: c_char, c_ptr, c_size_t
            implicit none
            character(kind=c_char), intent(inout) :: buffer(*)
            integer(c_size_t), value, intent(in) :: item_size, items
            type(c_ptr), value, intent(in) :: stream
        end function c_fread

        integer(c_int) function c_ferror(stream) bind(C, name='ferror')
            import :: c_int, c_ptr
            implicit none
            type(c_ptr), value, intent(in) :: stream
        end function c_ferror

        real(c_double) function c_strtod(text, end) bind(C, name='strtod')
            import :: c_char, c_double, c_ptr
            implicit none
            character(kind=c_char), intent(in) :: text(*)
            type(c_ptr), intent(out) :: end
        end function c_strtod

        pure integer(c_size_t) function c_strlen(text) bind(C, name='strlen')
            import :: c_ptr, c_size_t
            implicit none
            type(c_ptr), value, intent(in) :: text
        end function c_strlen
    end interface

end module c_library
