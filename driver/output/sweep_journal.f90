!> The journal of a sweep: each row as soon as it is finished, so that an interrupted sweep can go
!> on. It starts with the input that the rows belong to. Only whole lines count: the last one may be
!> incomplete.
module sweep_journal
    use platform, only : rename_file
    use text_file, only : output_file
    use whole_file, only : line_text, next_line, read_whole_file
    implicit none
    private

    public :: journal, read_rows

    type :: journal
        type(output_file) :: file
    contains
        procedure :: open, append
    end type journal

    character(len=*), parameter :: mark = '# '   !! starts a line of the input

contains

    !> Reads the rows that are there and makes ready for more. `problem` says why that cannot be.
    subroutine open(self, name, input, rows, problem)
        class(journal), intent(inout) :: self
        character(len=*), intent(in) :: name
        character(len=*), intent(in) :: input   !! what the rows depend on; lines ended by newlines
        type(line_text), allocatable, intent(out) :: rows(:)
        character(len=:), allocatable, intent(out) :: problem
        integer :: first, last, number, i

        call read_rows(name, input, rows, problem)
        if (len(problem) > 0) return
        call self%file%create(name // '.new')
        last = -1
        number = 0
        do while (last < len(input) - 1)
            call next_line(input, first, last, number)
            call self%file%write_line(mark // input(first:last))
        end do
        do i = 1, size(rows)
            call self%file%write_line(rows(i)%text)
        end do
        call self%file%flush_lines()
        if (self%file%failed) then
            problem = 'cannot write ' // name // '.new'
        else if (.not. rename_file(name // '.new', name)) then
            problem = 'cannot write ' // name
        end if
    end subroutine open

    !> Reads the rows of a journal that this or another process writes; none where there is no
    !> journal.
    subroutine read_rows(name, input, rows, problem)
        character(len=*), intent(in) :: name
        character(len=*), intent(in) :: input   !! what the rows depend on; lines ended by newlines
        type(line_text), allocatable, intent(out) :: rows(:)
        character(len=:), allocatable, intent(out) :: problem
        character(len=:), allocatable :: text, old_input
        type(line_text), allocatable :: lines(:)
        integer :: first, last, number, n, i

        old_input = ''
        call read_whole_file(name, text, problem)
        allocate (lines(count([(text(i:i) == new_line('a'), i = 1, len(text))])))
        last = -1
        number = 0
        n = 0
        do
            call next_line(text, first, last, number)
            if (last == len(text)) exit
            if (index(text(first:last), mark) == 1) then
                old_input = old_input // text(first + len(mark):last) // new_line('a')
            else
                n = n + 1
                lines(n)%text = text(first:last)
            end if
        end do
        rows = lines(:n)
        problem = ''
        if (len(old_input) > 0 .and. old_input /= input) problem = name // ' holds results of ' &
            // 'another input: delete it, or write elsewhere with --output'
    end subroutine read_rows

    !> Adds a row and hands it to the operating system at once.
    subroutine append(self, row)
        class(journal), intent(inout) :: self
        character(len=*), intent(in) :: row

        call self%file%write_line(row)
        call self%file%flush_lines()
    end subroutine append

end module sweep_journal
