!> The command line: what the user asks for.
module command_line
    use, intrinsic :: iso_fortran_env, only : error_unit
    use embedded_texts, only : get_text
    use friction_mod, only : friction_law_count, friction_law_name, friction_version
    use platform, only : report
    implicit none
    private

    public :: command, print_help, print_version, read_command_line

    type :: command
        character(len=:), allocatable :: verb      !! run, point, sweep, stability, fault, check,
                                                   !! --help, or --version
        character(len=:), allocatable :: input     !! namelist file
        character(len=:), allocatable :: output    !! directory
        character(len=:), allocatable :: stem      !! of the names of the files that a run writes
        logical :: plot = .true.
        logical :: quiet = .false.
        integer :: jobs = 0                        !! runs of a sweep at a time; 0: one a core
        integer :: part = 1, parts = 1             !! of the combinations of a sweep: part of parts
        logical :: resume = .false.
        logical :: verify = .false.
        character(len=:), allocatable :: problem   !! what is wrong with the command line; or empty
    end type command

contains

    subroutine read_command_line(wanted)
        type(command), intent(out) :: wanted
        integer :: dot

        wanted%problem = ''
        wanted%input = ''
        wanted%output = ''
        wanted%verb = argument(1)
        select case (wanted%verb)
        case ('run', 'point', 'sweep', 'stability', 'fault', 'check')
            continue
        case ('--help', '-h', 'help')
            wanted%verb = '--help'
            return
        case ('--version')
            return
        case ('')
            wanted%problem = 'no command given'
            return
        case default
            wanted%problem = "unknown command '" // wanted%verb // "'"
            return
        end select

        call read_options(wanted)
        if (wanted%verb == '--help') return
        if (len(wanted%problem) > 0) return
        if (len(wanted%input) == 0) wanted%problem = wanted%verb // ' needs an input file'
        if (wanted%verb /= 'run' .and. wanted%verify) wanted%problem = '--verify is for run'
        if (wanted%resume .and. wanted%verb /= 'run' .and. wanted%verb /= 'fault') then
            wanted%problem = '--resume is for run and fault'
        end if
        if (wanted%verb == 'check' .and. (len(wanted%output) > 0 .or. wanted%quiet &
            .or. .not. wanted%plot .or. wanted%resume &
            .or. wanted%verify)) wanted%problem = 'check takes an input file and nothing else'
        wanted%stem = wanted%input(index(wanted%input, '/', back=.true.) + 1:)
        dot = index(wanted%stem, '.', back=.true.)   ! of the last extension
        if (dot > 1) wanted%stem = wanted%stem(:dot - 1)
        if (len(wanted%output) == 0) wanted%output = wanted%stem // '_out'
    end subroutine read_command_line

    !> What follows the verb.
    subroutine read_options(wanted)
        type(command), intent(inout) :: wanted
        character(len=:), allocatable :: word
        integer :: i

        i = 2
        do while (i <= command_argument_count())
            word = argument(i)
            i = i + 1
            select case (word)
            case ('--help', '-h')
                wanted%verb = '--help'
                return
            case ('--no-plot')
                wanted%plot = .false.
            case ('--quiet')
                wanted%quiet = .true.
            case ('--resume')
                wanted%resume = .true.
            case ('--verify')
                wanted%verify = .true.
            case ('--output')
                wanted%output = argument(i)
                i = i + 1
                if (len(wanted%output) == 0) wanted%problem = '--output needs a directory'
            case ('--jobs')
                wanted%jobs = whole_number(argument(i))
                i = i + 1
                if (wanted%jobs == 0) wanted%problem = '--jobs needs a whole number from 1 to 9999'
                if (wanted%verb /= 'sweep') wanted%problem = '--jobs is for sweep'
            case ('--part')
                call take_part(wanted, argument(i))
                i = i + 1
            case default
                call take_input(wanted, word)
            end select
        end do
    end subroutine read_options

    subroutine take_input(wanted, word)
        type(command), intent(inout) :: wanted
        character(len=*), intent(in) :: word

        if (len(wanted%problem) > 0) return   ! the first mistake is the one to tell
        if (index(word, '-') == 1) then
            wanted%problem = "unknown option '" // word // "'"
        else if (len(wanted%input) > 0) then
            wanted%problem = "one input file at a time: '" // wanted%input // "' and '" // word &
                // "'"
        else
            wanted%input = word
        end if
    end subroutine take_input

    subroutine take_part(wanted, word)
        type(command), intent(inout) :: wanted
        character(len=*), intent(in) :: word   !! 'i/n'
        integer :: slash

        slash = index(word, '/')
        wanted%part = whole_number(word(:slash - 1))
        wanted%parts = whole_number(word(slash + 1:))
        if (slash == 0 .or. wanted%part == 0 .or. wanted%part > wanted%parts) wanted%problem = &
            '--part needs i/n, whole numbers with 1 <= i <= n <= 9999'
        if (wanted%verb /= 'sweep') wanted%problem = '--part is for sweep'
    end subroutine take_part

    !> From 1 to 9999; 0: it is none of these.
    pure integer function whole_number(word) result(number)
        character(len=*), intent(in) :: word

        number = 0
        if (len(word) == 0 .or. len(word) > 4 .or. verify(word, '0123456789') > 0) return
        read (word, '(i4)') number
    end function whole_number

    function argument(i) result(word)
        integer, intent(in) :: i
        character(len=:), allocatable :: word
        integer :: length

        call get_command_argument(i, length=length)
        allocate (character(len=length) :: word)
        if (length > 0) call get_command_argument(i, word)
    end function argument

    subroutine print_version()
        write (report, '(2a)') 'stickslip ', friction_version
    end subroutine print_version

    !> To standard output on request, to standard error after a mistake.
    subroutine print_help(to_error)
        logical, intent(in) :: to_error
        character(len=128), allocatable :: lines(:)
        integer :: i, unit

        call get_text('help', lines)
        unit = merge(error_unit, report, to_error)
        do i = 1, size(lines)
            if (lines(i) == '@laws@') then
                call print_laws(unit)
            else
                write (unit, '(a)') trim(lines(i))
            end if
        end do
    end subroutine print_help

    !> The names of all laws but the first, whose keys the help tells itself.
    subroutine print_laws(unit)
        integer, intent(in) :: unit
        integer, parameter :: width = 85
        character(len=*), parameter :: indent = repeat(' ', 13)
        character(len=:), allocatable :: line, name
        integer :: law

        line = indent
        do law = 2, friction_law_count
            name = trim(friction_law_name(law))
            if (law < friction_law_count) name = name // ','
            if (len(line) + 1 + len(name) > width) then
                write (unit, '(a)') line
                line = indent
            end if
            if (len(line) > len(indent)) line = line // ' '
            line = line // name
        end do
        write (unit, '(a)') line
    end subroutine print_laws

end module command_line
