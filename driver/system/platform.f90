!> What the program asks of the operating system: C library calls behind Fortran names.
module platform
    use, intrinsic :: iso_c_binding, only : c_char, c_funloc, c_funptr, c_int, c_int64_t, c_loc, &
        c_null_char, c_null_ptr, c_ptr, c_size_t
    use, intrinsic :: iso_fortran_env, only : error_unit, int64, output_unit, real64
    implicit none
    private

    public :: cores, exit_program, have_command, hold_output, interrupted, is_directory, &
        is_terminal, make_directory, program_beside, remove_file, rename_file, replace_program, &
        seconds, shell_word, truncate_file, watch_for_interrupts

    ! Module variables, because a signal handler has no arguments to leave its message in.
    logical, volatile :: was_interrupted = .false.
    !> Where the program says what it has found.
    integer, protected, public :: report = output_unit

    integer(c_int), parameter :: sigint = 2_c_int, sigterm = 15_c_int

    interface
        function c_execv(path, arguments) result(status) bind(C, name='execv')
            import :: c_char, c_int, c_ptr
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            type(c_ptr), intent(in) :: arguments(*)
            integer(c_int) :: status
        end function c_execv

        function c_readlink(path, buffer, length) result(got) bind(C, name='readlink')
            import :: c_char, c_size_t
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            character(kind=c_char), intent(inout) :: buffer(*)
            integer(c_size_t), value, intent(in) :: length
            integer(c_size_t) :: got   ! ssize_t, as wide and signed here
        end function c_readlink

        function c_isatty(descriptor) result(answer) bind(C, name='isatty')
            import :: c_int
            implicit none
            integer(c_int), value, intent(in) :: descriptor
            integer(c_int) :: answer
        end function c_isatty

        function c_mkdir(path, mode) result(status) bind(C, name='mkdir')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int), value, intent(in) :: mode
            integer(c_int) :: status
        end function c_mkdir

        function c_access(path, mode) result(status) bind(C, name='access')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int), value, intent(in) :: mode
            integer(c_int) :: status
        end function c_access

        function c_truncate(path, length) result(status) bind(C, name='truncate')
            import :: c_char, c_int, c_int64_t
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int64_t), value, intent(in) :: length
            integer(c_int) :: status
        end function c_truncate

        function c_rename(old, new) result(status) bind(C, name='rename')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: old(*), new(*)
            integer(c_int) :: status
        end function c_rename

        function c_remove(path) result(status) bind(C, name='remove')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: path(*)
            integer(c_int) :: status
        end function c_remove

        function c_signal(number, handler) result(before) bind(C, name='signal')
            import :: c_funptr, c_int
            implicit none
            integer(c_int), value, intent(in) :: number
            type(c_funptr), value, intent(in) :: handler
            type(c_funptr) :: before
        end function c_signal

        function c_puts(text) result(status) bind(C, name='puts')
            import :: c_char, c_int
            implicit none
            character(kind=c_char), intent(in) :: text(*)
            integer(c_int) :: status
        end function c_puts

        function c_fflush(stream) result(status) bind(C, name='fflush')
            import :: c_int, c_ptr
            implicit none
            type(c_ptr), value, intent(in) :: stream
            integer(c_int) :: status
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
    end interface

contains

    !> Keeps what the program says on standard output until `exit_program`. gfortran's run-time
    !> library reports success for output that is lost; the C library does not.
    subroutine hold_output()
        integer :: status

        open (newunit=report, status='scratch', action='readwrite', iostat=status)
        if (status /= 0) report = output_unit
    end subroutine hold_output

    !> Ends the program with an exit status, and without the remarks that `stop` would print.
    subroutine exit_program(status)
        integer, intent(in) :: status   !! 0 done, 1 the run failed, 2 bad usage or input
        integer :: end_status
        logical :: said

        end_status = status
        said = .true.
        if (report /= output_unit) call say_what_was_held(said)
        if (.not. said .and. status == 0) then
            write (error_unit, '(a)') 'stickslip: standard output cannot be written (disk full?)'
            end_status = 1
        end if
        flush (output_unit)
        flush (error_unit)
        call c_exit(int(end_status, c_int))
    end subroutine exit_program

    subroutine say_what_was_held(said)
        logical, intent(out) :: said   !! all of it has arrived
        character(len=8192) :: line
        integer :: status

        said = .true.
        rewind (report, iostat=status)
        do
            if (status == 0) read (report, '(a)', iostat=status) line
            if (status /= 0) exit
            said = said .and. c_puts(trim(line) // c_null_char) >= 0
        end do
        said = c_fflush(c_null_ptr) == 0 .and. said
    end subroutine say_what_was_held

    !> From now on Ctrl-C and a request to end are noted; the run ends after its step.
    subroutine watch_for_interrupts()
        type(c_funptr) :: before

        before = c_signal(sigint, c_funloc(note_interrupt))
        before = c_signal(sigterm, c_funloc(note_interrupt))
    end subroutine watch_for_interrupts

    !> A second signal ends the program at once.
    subroutine note_interrupt(number) bind(C)
        integer(c_int), value, intent(in) :: number
        integer(c_int), parameter :: by_signal = 128_c_int   !! as shells tell it

        if (was_interrupted) call c_end(by_signal + number)
        was_interrupted = .true.
    end subroutine note_interrupt

    function interrupted() result(yes)
        logical :: yes

        yes = was_interrupted
    end function interrupted

    !> Cuts a file to a length.
    function truncate_file(path, length) result(done)
        character(len=*), intent(in) :: path
        integer(int64), intent(in) :: length   !! bytes
        logical :: done

        done = c_truncate(path // c_null_char, length) == 0
    end function truncate_file

    subroutine remove_file(path)
        character(len=*), intent(in) :: path
        integer(c_int) :: ignored

        ignored = c_remove(path // c_null_char)
    end subroutine remove_file

    !> Is standard error a terminal?
    function is_terminal() result(terminal)
        logical :: terminal

        terminal = c_isatty(2_c_int) == 1
    end function is_terminal

    !> Is there a directory of this name? Opened as a file, one looks like an empty file.
    function is_directory(path) result(yes)
        character(len=*), intent(in) :: path
        logical :: yes

        inquire (file=path // '/.', exist=yes)
    end function is_directory

    !> Makes a directory and those above it, where they do not exist; tells whether it can be
    !> written to.
    function make_directory(path) result(made)
        character(len=*), intent(in) :: path
        logical :: made
        integer(c_int), parameter :: for_all = int(o'777', c_int)     ! less the user's umask
        integer(c_int), parameter :: write_and_search = 3_c_int       ! W_OK + X_OK of unistd.h
        integer :: i
        integer(c_int) :: ignored

        do i = 2, len(path)
            if (path(i:i) == '/') ignored = c_mkdir(path(:i - 1) // c_null_char, for_all)
        end do
        ignored = c_mkdir(path // c_null_char, for_all)
        made = c_access(path // '/.' // c_null_char, write_and_search) == 0
    end function make_directory

    !> The path of a program in the directory of this one; its name alone where that is unknown.
    function program_beside(name) result(path)
        character(len=*), intent(in) :: name
        character(len=:), allocatable :: path
        character(len=4096) :: own
        integer(c_size_t) :: length
        integer :: status

        length = c_readlink('/proc/self/exe' // c_null_char, own, len(own, c_size_t))
        if (length <= 0) then
            call get_command_argument(0, own, status=status)
            length = len_trim(own)
        end if
        path = own(:index(own(:length), '/', back=.true.)) // name
    end function program_beside

    !> Runs another program in place of this one, in the same process: under a launcher of many
    !> processes it is still the one that was launched. Returns only if that program cannot be run.
    subroutine replace_program(path, arguments)
        character(len=*), intent(in) :: path
        character(len=*), intent(in) :: arguments(:)   !! trailing blanks do not count
        character(kind=c_char), target :: words(len(arguments) + 1, size(arguments))
        type(c_ptr) :: list(size(arguments) + 2)
        character(kind=c_char), target :: name(len(path) + 1)
        integer(c_int) :: ignored
        integer :: i, j

        do j = 1, len(path)
            name(j) = path(j:j)
        end do
        name(len(path) + 1) = c_null_char
        list(1) = c_loc(name)
        do i = 1, size(arguments)
            do j = 1, len_trim(arguments(i))
                words(j, i) = arguments(i)(j:j)
            end do
            words(len_trim(arguments(i)) + 1, i) = c_null_char
            list(i + 1) = c_loc(words(:, i))
        end do
        list(size(list)) = c_null_ptr
        flush (output_unit)
        flush (error_unit)
        ignored = c_execv(path // c_null_char, list)
    end subroutine replace_program

    !> Gives a file another name; a file that had that name is replaced at once and whole.
    function rename_file(from, to) result(renamed)
        character(len=*), intent(in) :: from, to
        logical :: renamed

        renamed = c_rename(from // c_null_char, to // c_null_char) == 0
    end function rename_file

    !> Is there a program of this name?
    function have_command(name) result(found)
        character(len=*), intent(in) :: name
        logical :: found
        integer :: status, started

        call execute_command_line('command -v ' // name // ' >/dev/null 2>&1', exitstat=status, &
            cmdstat=started)
        found = started == 0 .and. status == 0
    end function have_command

    !> Processors that this process may use; at most 255 are told, the largest exit status.
    function cores() result(n)
        integer :: n
        integer :: started

        n = 1   ! execute_command_line reads it too
        call execute_command_line('{ n=$(nproc || getconf _NPROCESSORS_ONLN); } 2>/dev/null; ' &
            // '[ "${n:-1}" -le 255 ] || n=255; exit "${n:-1}"', exitstat=n, cmdstat=started)
        if (started /= 0 .or. n < 1) n = 1
    end function cores

    !> A path as one word of the shell, whatever it contains.
    pure function shell_word(path) result(word)
        character(len=*), intent(in) :: path
        character(len=:), allocatable :: word
        integer :: i

        word = "'"
        do i = 1, len(path)
            if (path(i:i) == "'") then
                word = word // "'\''"
            else
                word = word // path(i:i)
            end if
        end do
        word = word // "'"
        if (path(1:1) == '-') word = './' // word
    end function shell_word

    !> Wall-clock time [s].
    function seconds() result(time)
        real(real64) :: time
        integer(int64) :: count, rate

        call system_clock(count, rate)
        time = real(count, real64) / real(rate, real64)
    end function seconds

end module platform
