!> What the program asks of the operating system: C library calls behind Fortran names.
module platform
    use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_funloc, c_funptr, c_int, &
        c_intptr_t, c_loc, c_null_char, c_null_ptr, c_ptr, c_size_t
    use, intrinsic :: iso_fortran_env, only : error_unit, int64, output_unit, real64
    use c_library, only : c_access, c_end, c_execv, c_exit, c_fflush, c_isatty, c_madvise, &
        c_mkdir, c_puts, c_realpath, c_remove, c_rename, c_signal, c_truncate
    use printable_text, only : replaced
    implicit none
    private

    public :: cores, exit_program, have_command, hold_output, interrupted, is_directory, &
        is_terminal, make_directory, plain_path, program_beside, remove_file, rename_file, &
        replace_program, seconds, shell_word, truncate_file, use_large_pages, &
        watch_for_interrupts

    ! Module variables, because a signal handler has no arguments to leave its message in.
    logical, volatile :: was_interrupted = .false.
    !> Where the program says what it has found.
    integer, protected, public :: report = output_unit

    integer(c_int), parameter :: sigint = 2_c_int, sigterm = 15_c_int

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

    logical function interrupted() result(yes)
        yes = was_interrupted
    end function interrupted

    !> Cuts a file to a length.
    logical function truncate_file(path, length) result(done)
        character(len=*), intent(in) :: path
        integer(int64), intent(in) :: length   !! bytes

        done = c_truncate(path // c_null_char, length) == 0
    end function truncate_file

    subroutine remove_file(path)
        character(len=*), intent(in) :: path
        integer(c_int) :: ignored

        ignored = c_remove(path // c_null_char)
    end subroutine remove_file

    !> Is standard error a terminal?
    logical function is_terminal() result(terminal)
        terminal = c_isatty(2_c_int) == 1
    end function is_terminal

    !> Is there a directory of this name? Opened as a file, one looks like an empty file.
    logical function is_directory(path) result(yes)
        character(len=*), intent(in) :: path

        inquire (file=path // '/.', exist=yes)
    end function is_directory

    !> Makes a directory and those above it, where they do not exist; tells whether it can be
    !> written to.
    logical function make_directory(path) result(made)
        character(len=*), intent(in) :: path
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

    !> The path of a file or directory from the root on, without links; empty if there is none.
    function plain_path(path) result(full)
        character(len=*), intent(in) :: path
        character(len=:), allocatable :: full
        character(kind=c_char, len=4096) :: resolved

        full = ''
        resolved = ' '
        if (.not. c_associated(c_realpath(path // c_null_char, resolved))) return
        full = resolved(:index(resolved, c_null_char) - 1)
    end function plain_path

    !> The path of a program in the directory of this one; its name alone where that is unknown.
    function program_beside(name) result(path)
        character(len=*), intent(in) :: name
        character(len=:), allocatable :: path
        character(len=4096) :: own

        path = plain_path('/proc/self/exe')
        if (len(path) == 0) then
            call get_command_argument(0, own)
            path = trim(own)
        end if
        path = path(:index(path, '/', back=.true.)) // name
    end function program_beside

    !> Runs another program in place of this one, in the same process: under a launcher of many
    !> processes it is still the one that was launched. Returns only if that program cannot be run.
    subroutine replace_program(path, arguments)
        character(len=*), intent(in) :: path
        character(len=*), intent(in) :: arguments(:)   !! trailing blanks do not count
        character(kind=c_char, len=max(len(path), len(arguments)) + 1), target :: &
            words(0:size(arguments))
        type(c_ptr) :: list(0:size(arguments) + 1)
        integer(c_int) :: ignored
        integer :: i

        words(0) = path // c_null_char
        do i = 1, size(arguments)
            words(i) = trim(arguments(i)) // c_null_char
        end do
        list = c_null_ptr
        do i = 0, size(arguments)
            list(i) = c_loc(words(i))
        end do
        flush (output_unit)
        flush (error_unit)
        ignored = c_execv(path // c_null_char, list)
    end subroutine replace_program

    !> Gives a file another name; a file that had that name is replaced at once and whole.
    logical function rename_file(from, to) result(renamed)
        character(len=*), intent(in) :: from, to

        renamed = c_rename(from // c_null_char, to // c_null_char) == 0
    end function rename_file

    !> Is there a program of this name?
    logical function have_command(name) result(found)
        character(len=*), intent(in) :: name
        integer :: status, started

        call execute_command_line('command -v ' // name // ' >/dev/null 2>&1', exitstat=status, &
            cmdstat=started)
        found = started == 0 .and. status == 0
    end function have_command

    !> Processors that this process may use; at most 255 are told, the largest exit status.
    integer function cores() result(n)
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

        word = "'" // replaced(path, "'", "'\''") // "'"
        if (path(1:1) == '-') word = './' // word
    end function shell_word

    !> Wall-clock time [s].
    real(real64) function seconds() result(time)
        integer(int64) :: count, rate

        call system_clock(count, rate)
        time = real(count, real64) / real(rate, real64)
    end function seconds

    !> Asks the system to keep an array in large pages, of 2 MiB: a loop over many arrays at once
    !> else waits for page tables where they are longer than these reach. What it cannot do it
    !> leaves. Other systems than Linux have other advice, or large pages without being asked.
    subroutine use_large_pages(n, numbers)
        integer, intent(in) :: n                        !! numbers
        real(real64), intent(in), target :: numbers(n)   !! to be filled, or filled already
        integer(c_int), parameter :: huge_pages = 14_c_int, collapse = 25_c_int   ! Linux 6.1 on
        integer(c_intptr_t), parameter :: page = 2_c_intptr_t**21   ! [bytes]
        integer(c_intptr_t) :: first, behind
        integer(c_int) :: status
        logical :: linux

        first = transfer(c_loc(numbers), first)
        behind = (first + 8_c_intptr_t * n) / page * page
        first = (first + page - 1) / page * page
        if (behind <= first) return
        inquire (file='/sys/kernel/mm/transparent_hugepage/enabled', exist=linux)
        if (.not. linux) return
        status = c_madvise(first, int(behind - first, c_size_t), huge_pages)
        if (status == 0) status = c_madvise(first, int(behind - first, c_size_t), collapse)
    end subroutine use_large_pages

end module platform
