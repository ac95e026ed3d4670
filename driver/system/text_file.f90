!> Files for results, line by line, through the C library: gfortran's own output takes a full
!> disk for success.
module text_file
    use, intrinsic :: iso_c_binding, only : c_associated, c_null_char, c_null_ptr, c_ptr, c_size_t
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use c_library, only : c_fclose, c_fflush, c_fopen, c_fwrite
    use number_text, only : full_row
    use platform, only : truncate_file
    implicit none
    private

    public :: end_of_file, output_file, write_numbers

    real(dp), parameter, public :: gigabyte = 1.0e9_dp   !! [bytes]

    !> A file that is written line by line. After the first failure nothing more is written; what is
    !> written to a file that was never created is dropped.
    type :: output_file
        private
        type(c_ptr) :: stream = c_null_ptr
        character(len=:), allocatable :: name
        integer(int64), public :: bytes = 0   !! written so far
        logical, public :: failed = .false.   !! a line could not be written, or the file not opened
    contains
        procedure :: create, go_on, write_line, flush_lines, finish
    end type output_file

contains

    !> Opens a new file, or empties the one that has the name.
    subroutine create(self, name)
        class(output_file), intent(inout) :: self
        character(len=*), intent(in) :: name

        self%name = name
        self%stream = c_fopen(name // c_null_char, 'w' // c_null_char)
        self%failed = .not. c_associated(self%stream)
    end subroutine create

    !> Opens a file that is there, and goes on behind its first `bytes`; what follows them is lost.
    subroutine go_on(self, name, bytes)
        class(output_file), intent(inout) :: self
        character(len=*), intent(in) :: name
        integer(int64), intent(in) :: bytes
        integer(int64) :: found

        inquire (file=name, size=found)
        self%failed = found < bytes
        if (.not. self%failed) self%failed = .not. truncate_file(name, bytes)
        if (self%failed) return
        self%name = name
        self%stream = c_fopen(name // c_null_char, 'a' // c_null_char)
        self%failed = .not. c_associated(self%stream)
        self%bytes = bytes
    end subroutine go_on

    subroutine write_line(self, line)
        class(output_file), intent(inout) :: self
        character(len=*), intent(in) :: line

        integer(c_size_t) :: length

        if (self%failed .or. .not. c_associated(self%stream)) return
        length = len(line, c_size_t) + 1
        self%failed = c_fwrite(line // new_line('a'), 1_c_size_t, length, self%stream) /= length
        self%bytes = self%bytes + length
    end subroutine write_line

    !> Hands all lines to the operating system.
    subroutine flush_lines(self)
        class(output_file), intent(inout) :: self

        if (self%failed .or. .not. c_associated(self%stream)) return
        self%failed = c_fflush(self%stream) /= 0
    end subroutine flush_lines

    !> Closes the file. Of a line that did not fit on the disk nothing is left: the part of a number
    !> would be read as another one.
    subroutine finish(self)
        class(output_file), intent(inout) :: self

        if (.not. c_associated(self%stream)) return
        if (c_fclose(self%stream) /= 0) self%failed = .true.
        self%stream = c_null_ptr
        if (self%failed) call cut_to_whole_lines(self%name)
    end subroutine finish

    subroutine cut_to_whole_lines(name)
        character(len=*), intent(in) :: name
        integer, parameter :: longest = 4096   ! line
        character(len=:), allocatable :: tail
        integer(int64) :: length
        integer :: last
        logical :: done

        call end_of_file(name, longest, tail, length)
        last = index(tail, new_line('a'), back=.true.)
        if (last > 0) done = truncate_file(name, length - len(tail) + last)
    end subroutine cut_to_whole_lines

    !> Writes a table of numbers as a file of its own.
    subroutine write_numbers(name, header, rows, written)
        character(len=*), intent(in) :: name, header
        real(dp), intent(in) :: rows(:, :)   !! column, row
        logical, intent(out) :: written      !! all of it
        type(output_file) :: file
        integer :: i

        call file%create(name)
        call file%write_line(header)
        do i = 1, size(rows, 2)
            call file%write_line(full_row(rows(:, i)))
        end do
        call file%finish()
        written = .not. file%failed
    end subroutine write_numbers

    !> The last bytes of a file; none if it cannot be read.
    subroutine end_of_file(name, most, tail, length)
        character(len=*), intent(in) :: name
        integer, intent(in) :: most              !! bytes
        character(len=:), allocatable, intent(out) :: tail
        integer(int64), intent(out) :: length    !! of the file [bytes]
        integer :: unit, status

        tail = ''
        length = 0
        open (newunit=unit, file=name, access='stream', form='unformatted', action='read', &
            status='old', iostat=status)
        if (status /= 0) return
        inquire (unit=unit, size=length)
        tail = repeat(' ', int(min(length, int(most, int64))))
        if (len(tail) > 0) read (unit, pos=length - len(tail) + 1, iostat=status) tail
        close (unit)
        if (status /= 0) tail = ''
    end subroutine end_of_file

end module text_file
